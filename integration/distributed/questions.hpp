// SPDX-License-Identifier: Zlib
#pragma once

// Queries to all ranks: objects that touch a box, lie within a distance, or are met by a ray, wherever they live.
//
//     for (const Parcel& parcel : asked.pack(grid, questions)) { send(parcel.rank, parcel.bytes); }
//     for (const Parcel& parcel : asked.answer(grid, received)) { send(parcel.rank, parcel.bytes); }
//     const Answers<float> answers = asked.finish(received);
//
// Transport  Your program carries the parcels, as for RankGrid.
// Frame      By all ranks together, even without a question, after RankGrid::finish() and before the next change
//            (asserted).
// Result     Does not depend on the number of ranks.
// Failure    answer() and finish() throw RankError, as RankGrid::finish() does.
// Bad data   A question with a NaN finds nothing.

#include <integration/distributed/rank_grid.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace hashphase {

/// A query, and the most objects that it wants. Make it by box(), sphere() or ray().
template <class Scalar>
struct Question {
    enum class Shape : std::uint8_t { box, sphere, ray };

    Shape shape = Shape::box;
    Aabb<Scalar> extent;  ///< the box; or the box that moves along the ray, relative to it [m]
    Vector3<Scalar> from = Vector3<Scalar>::Zero();  ///< beginning of a ray, centre of a ball [m]
    Vector3<Scalar> to = Vector3<Scalar>::Zero();    ///< end of a ray [m]
    Scalar radius = 0;                               ///< of a ball [m]
    std::uint32_t most = ~std::uint32_t{0};  ///< keeps at most this many, with the smallest keys

    /// Finds as BoxRegion.
    [[nodiscard]] static Question box(const Aabb<Scalar>& box,
                                      std::uint32_t most = ~std::uint32_t{0}) {
        Question question;
        question.extent = box;
        question.most = most;
        return question;
    }
    /// Finds as SphereRegion. With `most`, finds the nearest objects.
    [[nodiscard]] static Question sphere(const Vector3<Scalar>& center, Scalar radius,
                                         std::uint32_t most = ~std::uint32_t{0}) {
        Question question;
        question.shape = Shape::sphere;
        question.from = center;
        question.radius = radius;
        question.most = most;
        return question;
    }
    /// Finds as RayRegion. With `most` 1, finds the first box that the ray enters.
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

/// An object found.
template <class Scalar>
struct FoundObject {
    Scalar key =
        0;  ///< as the region defines it: 0, a squared distance [m^2], or a fraction of the ray
    GlobalId object;
    std::uint32_t home = 0;  ///< the rank on which it lives

    friend constexpr auto operator<=>(const FoundObject&, const FoundObject&) = default;
};

/// The answers to all questions of this rank. Valid until the next RankQuestions::finish().
template <class Scalar>
struct Answers {
    std::span<const FoundObject<Scalar>> found;
    std::span<const std::size_t>
        begins;  ///< of each answer in `found`, and the end of the last one

    /// Returns the answer to question i: each object once, sorted by key, then by id.
    [[nodiscard]] std::span<const FoundObject<Scalar>> of(std::size_t i) const noexcept {
        return found.subspan(begins[i], begins[i + 1] - begins[i]);
    }
};

/// Questions of one rank, and its answers to others. Keeps its memory.
template <class Scalar>
class HASHPHASE_DISTRIBUTED_TEMPLATE_EXPORT RankQuestions {
public:
    /// Returns parcels of questions for other ranks, valid until the next call, and answers from this rank's own
    /// grid. Throws std::length_error beyond 2^32 - 1 questions. Cost: O(log ranks) for each rank concerned, and the
    /// queries here.
    std::span<const Parcel> pack(const RankGrid<Scalar>& grid,
                                 std::span<const Question<Scalar>> questions);

    /// Answers the questions of other ranks. Valid until the next call. Cost: a query for each question.
    std::span<const Parcel> answer(const RankGrid<Scalar>& grid, std::span<const Parcel> received);

    /// Joins the answers of all ranks. Cost: O(found * log(found)).
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

    std::vector<detail::ByteWriter> writers_;  // by rank
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
