// SPDX-License-Identifier: Zlib
#pragma once

// Queries to all ranks concerned: what touches a box, lies within a distance, or is met by a ray, wherever it lives.
// Knows no transport, as RankGrid: questions are carried to the ranks whose regions they touch, answers back.
//
//     for (const Parcel& parcel : asked.pack(grid, questions)) { send(parcel.rank, parcel.bytes); }
//     for (const Parcel& parcel : asked.answer(grid, received)) { send(parcel.rank, parcel.bytes); }
//     const Answers<float> answers = asked.finish(received);
//
// Frame     asked by all ranks together, where one has no question as well; after RankGrid::finish() and before the
//           next change (asserted)
// Result    the same for any number of ranks
// Failure   throws RankError as RankGrid::finish() does
// Bad data  A question with a NaN finds nothing.

#include <integration/distributed/rank_grid.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace hashphase {

/// A query, and how much of its answer is wanted. Make it by box(), sphere() or ray().
template <class Scalar>
struct Question {
    enum class Shape : std::uint8_t { box, sphere, ray };

    Shape shape = Shape::box;
    Aabb<Scalar> extent;  ///< the box; or the box that moves along a ray, relative to it [m]
    Vector3<Scalar> from = Vector3<Scalar>::Zero();  ///< a ray's first end; a ball's middle
    Vector3<Scalar> to = Vector3<Scalar>::Zero();    ///< a ray's other end
    Scalar radius = 0;                               ///< a ball's
    std::uint32_t most = ~std::uint32_t{0};  ///< keeps so many, those with the smallest keys

    /// What BoxRegion finds.
    [[nodiscard]] static Question box(const Aabb<Scalar>& box,
                                      std::uint32_t most = ~std::uint32_t{0}) {
        Question question;
        question.extent = box;
        question.most = most;
        return question;
    }
    /// What SphereRegion finds. With `most`, the nearest objects.
    [[nodiscard]] static Question sphere(const Vector3<Scalar>& center, Scalar radius,
                                         std::uint32_t most = ~std::uint32_t{0}) {
        Question question;
        question.shape = Shape::sphere;
        question.from = center;
        question.radius = radius;
        question.most = most;
        return question;
    }
    /// What RayRegion finds. With a `most` of 1, the first box that the ray enters.
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
        begins;  ///< where each answer begins in `found`, and where the last one ends

    /// The answer to question i, each object once, sorted by key, then by id.
    [[nodiscard]] std::span<const FoundObject<Scalar>> of(std::size_t i) const noexcept {
        return found.subspan(begins[i], begins[i + 1] - begins[i]);
    }
};

/// The questions of one rank, and its answers to those of others. Keeps its memory.
template <class Scalar>
class HASHPHASE_DISTRIBUTED_TEMPLATE_EXPORT RankQuestions {
public:
    /// Returns the questions for other ranks, and answers what this rank can. Valid until the next call.
    /// Cost: O(log ranks) for each rank concerned.
    std::span<const Parcel> pack(const RankGrid<Scalar>& grid,
                                 std::span<const Question<Scalar>> questions);

    /// Answers what other ranks have asked. Valid until the next call. Cost: a query for each question.
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
