// SPDX-License-Identifier: Zlib
#pragma once

// Queries to all ranks: find objects that touch a box, are within a distance of a point, or are hit by a ray, on any
// rank.
//
//     for (const Parcel& parcel : asked.pack(grid, questions)) { send(parcel.rank, parcel.bytes); }
//     for (const Parcel& parcel : asked.answer(grid, received)) { send(parcel.rank, parcel.bytes); }
//     const Answers<float> answers = asked.finish(received);
//
// Transport  Your program sends the parcels, as for RankGrid.
// Frame      After RankGrid::finish() and before the next change (asserted), all ranks call pack(), answer() and
//            finish(), even ranks that have no question.
// Result     Answers, except FoundObject::home, do not depend on the number of ranks.
// Failure    answer() and finish() throw RankError if a parcel is invalid.
// Bad data   A question with a NaN finds nothing.

#include <integration/distributed/rank_grid.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace hashphase {

/// A query, and the maximum number of objects to find. Make it with box(), sphere() or ray().
template <class Scalar>
struct Question {
    enum class Shape : std::uint8_t { box, sphere, ray };

    Shape shape = Shape::box;
    /// The box. For a ray: the box that moves along the ray, relative to the moving point [m].
    Aabb<Scalar> extent;
    Vector3<Scalar> from = Vector3<Scalar>::Zero();  ///< start of a ray, centre of a sphere [m]
    Vector3<Scalar> to = Vector3<Scalar>::Zero();    ///< end of a ray [m]
    Scalar radius = 0;                               ///< of a sphere [m]
    /// Maximum number of objects. The smallest keys win; among equal keys, the smallest ids.
    std::uint32_t most = ~std::uint32_t{0};

    /// Finds the objects that touch a box (BoxRegion).
    [[nodiscard]] static Question box(const Aabb<Scalar>& box,
                                      std::uint32_t most = ~std::uint32_t{0}) {
        Question question;
        question.extent = box;
        question.most = most;
        return question;
    }
    /// Finds the objects that touch a sphere (SphereRegion), at most the `most` nearest objects.
    [[nodiscard]] static Question sphere(const Vector3<Scalar>& center, Scalar radius,
                                         std::uint32_t most = ~std::uint32_t{0}) {
        Question question;
        question.shape = Shape::sphere;
        question.from = center;
        question.radius = radius;
        question.most = most;
        return question;
    }
    /// Finds the objects that a ray hits (RayRegion describes `fatness`). If `most` is 1, finds the first box that
    /// the ray enters.
    [[nodiscard]] static Question ray(const Vector3<Scalar>& from, const Vector3<Scalar>& to,
                                      std::uint32_t most = ~std::uint32_t{0},
                                      const Aabb<Scalar>& fatness = {Vector3<Scalar>::Zero(),
                                                                     Vector3<Scalar>::Zero()}) {
        Question question;
        question.shape = Shape::ray;
        question.extent = fatness;
        question.from = from;
        question.to = to;
        question.most = most;
        return question;
    }
};

/// An object that was found.
template <class Scalar>
struct FoundObject {
    Scalar key =
        0;  ///< always 0 for a box; squared distance [m^2] for a sphere; fraction (0 at the start) for a ray
    GlobalId object;
    std::uint32_t home = 0;  ///< the rank that owns the object

    friend constexpr auto operator<=>(const FoundObject&, const FoundObject&) = default;
};

/// The answers to all questions of this rank. Valid until the next RankQuestions::finish().
template <class Scalar>
struct Answers {
    std::span<const FoundObject<Scalar>> found;
    std::span<const std::size_t>
        begins;  ///< indices in `found` at which answers begin, and the end of the last answer

    /// Returns the answer to question i: each object once, sorted by key, then by id.
    [[nodiscard]] std::span<const FoundObject<Scalar>> of(std::size_t i) const noexcept {
        return found.subspan(begins[i], begins[i + 1] - begins[i]);
    }
};

/// Questions of one rank, and its answers to other ranks. Reuses its memory.
template <class Scalar>
class HASHPHASE_DISTRIBUTED_TEMPLATE_EXPORT RankQuestions {
public:
    /// Returns parcels of questions for other ranks, valid until the next pack() or answer(). Also queries this
    /// rank's grid. Throws std::length_error beyond 2^32 - 1 questions. Cost: O(log ranks) for each question and each
    /// rank that gets it, plus the queries on this rank.
    std::span<const Parcel> pack(const RankGrid<Scalar>& grid,
                                 std::span<const Question<Scalar>> questions);

    /// Returns parcels of answers for other ranks, valid until the next pack() or answer(). Cost: one query for each
    /// question.
    std::span<const Parcel> answer(const RankGrid<Scalar>& grid, std::span<const Parcel> received);

    /// Returns all ranks' answers to this rank's questions. Cost: O(n log n) for n found objects.
    Answers<Scalar> finish(std::span<const Parcel> received);

private:
    struct Numbered {
        std::uint32_t question = 0;
        FoundObject<Scalar> found;

        friend constexpr auto operator<=>(const Numbered&, const Numbered&) = default;
    };

    detail::ByteWriter& writerFor(std::uint32_t rank, std::uint32_t rankCount, std::uint32_t magic);
    void clearWriters();
    std::span<const Parcel> sealParcels();

    std::vector<detail::ByteWriter> writers_;  // index: rank
    std::vector<std::uint32_t> destinations_;
    std::vector<Parcel> parcels_;
    std::vector<FoundObject<Scalar>> answer_;  // to one question
    std::vector<Numbered> numbered_;
    std::vector<std::uint32_t> mosts_;
    std::vector<FoundObject<Scalar>> found_;
    std::vector<std::size_t> begins_;
};

extern template class RankQuestions<float>;
extern template class RankQuestions<double>;

}  // namespace hashphase
