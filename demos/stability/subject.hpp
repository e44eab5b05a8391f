// SPDX-License-Identifier: Zlib
#pragma once

// Who is asked in a hard case: a broadphase by Bullet's interface, or our grid alone in either
// precision.

#include <broadphase/pairs.hpp>
#include <demos/scenes/pair_key.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace hashphase::demos {

using Keys = std::vector<PairKey>;
using Objects = std::vector<std::uint32_t>;
template <class Scalar>
using Boxes = std::vector<Aabb<Scalar>>;
template <class Scalar>
using Plane = Eigen::Hyperplane<Scalar, 3>;

/// What must be known beforehand.
template <class Scalar>
struct SubjectNeeds {
    Aabb<Scalar> world;  // of everything that will ever be set
    std::size_t objects = 0;
    GridConfig grid = {};  // of ours
};

/// Objects are numbers below SubjectNeeds::objects.
template <class Scalar>
class Subject {
public:
    using Box = Aabb<Scalar>;
    using Point = Vector3<Scalar>;

    Subject() = default;
    Subject(const Subject&) = delete;
    Subject& operator=(const Subject&) = delete;
    virtual ~Subject() = default;

    virtual void create(std::uint32_t object, const Box& box) = 0;
    virtual void move(std::uint32_t object, const Box& box) = 0;
    virtual void destroy(std::uint32_t object) = 0;

    /// Finds the pairs; then they are listed, sorted.
    virtual void findPairs() = 0;
    virtual void listPairs(Keys& pairs) const = 0;

    /// Who touches the region, as often as it is told and in that order.
    [[nodiscard]] virtual Objects touching(const Box& region) const = 0;

    // --- Of some only ------------------------------------------------------------------------

    /// What a ray finds through Bullet's interface, sorted, and whether Bullet's test of a box says
    /// so; `cast` is moved along it.
    [[nodiscard]] virtual std::optional<Objects> rayTest(const Point& /*from*/, const Point& /*to*/,
                                                         const Box& /*cast*/) const {
        return std::nullopt;
    }
    [[nodiscard]] virtual bool passesRayTest(const Point& /*from*/, const Point& /*to*/,
                                             const Box& /*cast*/, const Box& /*box*/) const {
        return false;
    }

    /// What is in front of no plane, by Bullet's trees, sorted.
    [[nodiscard]] virtual std::optional<Objects> behindAll(
        std::span<const Plane<Scalar>> /*planes*/) const {
        return std::nullopt;
    }

    /// The height of the ground below a point, by Bullet's way; three corners a triangle.
    using GroundBelow = std::function<std::optional<double>(const Point&)>;
    [[nodiscard]] virtual GroundBelow groundOf(std::span<const Point> /*corners*/) const {
        return {};
    }

    // --- Of ours -----------------------------------------------------------------------------

    /// nullptr for any other. Its proxies are numbered as the objects, as long as none was destroyed.
    [[nodiscard]] virtual const Grid<Scalar>* grid() const { return nullptr; }

    /// Of the last findPairs().
    [[nodiscard]] virtual PairCost cost() const { return {}; }
    [[nodiscard]] virtual std::size_t memoryBytes() const { return 0; }

    /// The first invariant that does not hold, as a sentence.
    [[nodiscard]] virtual std::string validate() const { return {}; }
};

template <class Scalar>
using MakeSubject =
    std::function<std::unique_ptr<Subject<Scalar>>(const SubjectNeeds<Scalar>& needs)>;

/// Grid and Pairs. All that pairs report is checked on the way; validate() tells.
template <class Scalar>
[[nodiscard]] std::unique_ptr<Subject<Scalar>> makeGridSubject(const SubjectNeeds<Scalar>& needs);

}  // namespace hashphase::demos
