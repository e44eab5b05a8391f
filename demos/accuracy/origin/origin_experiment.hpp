// SPDX-License-Identifier: Zlib
#pragma once

// P6: ways to keep a world far from the origin: in what numbers boxes are filed and rays are cast;
// what becomes of pairs, rays and resting bodies there, and what it costs to have them right.

#include <demos/accuracy/exact_entry.hpp>
#include <demos/accuracy/experiment.hpp>
#include <demos/scenes/pair_key.hpp>
#include <demos/scenes/physics_world.hpp>

namespace hashphase::demos {

/// The closed box from centre - half to centre + half [units].
struct IntegerBox {
    WholePoint centre{};
    WholePoint half{};
};

struct IntegerRay {
    WholePoint from{};
    WholePoint to{};
};

/// The same in the world [m].
struct WorldBox {
    Vector3<double> centre;
    Vector3<double> half;
};
struct WorldRay {
    Vector3<double> from;
    Vector3<double> to;
};

/// Where the scene is, and how large a unit is there [m]; both powers of two, the offset also 0.
struct BodyPlacement {
    double offset = 0;  // along all three axes
    double unit = 1;

    [[nodiscard]] Vector3<double> operator()(const WholePoint& point) const {
        return {offset + unit * static_cast<double>(point[0]),
                offset + unit * static_cast<double>(point[1]),
                offset + unit * static_cast<double>(point[2])};
    }
    [[nodiscard]] WorldBox operator()(const IntegerBox& box) const {
        return {(*this)(box.centre), BodyPlacement{0, unit}(box.half)};
    }
    [[nodiscard]] WorldRay operator()(const IntegerRay& ray) const {
        return {(*this)(ray.from), (*this)(ray.to)};
    }
};

/// Boxes in whole multiples of a unit that is a power of two: wherever they are put, by a power of two as
/// well, their coordinates are exact in double precision, and what overlaps what can be said exactly, in
/// integers.
class OriginScene {
public:
    /// Half of the boxes and rays have coordinates that are multiples of so many units, so that
    /// many just touch or graze.
    static constexpr std::int64_t kStep = 64;

    /// The coordinates of the others are multiples of `finest` units, a divisor of kStep.
    OriginScene(std::size_t boxes, std::size_t rays, std::int64_t finest, std::uint64_t seed);

    /// Moves every box by up to kStep along every axis.
    void advance();

    [[nodiscard]] const std::vector<IntegerBox>& boxes() const noexcept { return boxes_; }
    [[nodiscard]] const std::vector<IntegerRay>& rays() const noexcept { return rays_; }

private:
    std::vector<IntegerBox> boxes_;
    std::vector<WholePoint> velocities_;
    std::vector<IntegerRay> rays_;
};

/// Exactly: whether two boxes share a point, whether a segment and a box do.
[[nodiscard]] bool overlapExactly(const IntegerBox& a, const IntegerBox& b);
[[nodiscard]] bool meetExactly(const IntegerRay& ray, const IntegerBox& box);

/// A world whose boxes are given in double precision. Boxes are numbered.
struct OriginWorld {
    /// Sets all boxes, always as many, and brings the pairs up to date.
    std::function<void(std::span<const WorldBox>)> set;

    /// Appends the pairs as of the last set(), in any order.
    std::function<void(std::vector<PairKey>&)> listPairs;

    /// Appends the boxes that the ray meets, in any order.
    std::function<void(const WorldRay&, std::vector<std::uint32_t>& boxes)> listHits;
};

/// misses_no_pair, misses_no_hit  at any distance
/// exact                          finds precisely the pairs that there are, at any distance
using OriginMethod = Method<OriginWorld()>;

/// In single precision as it is, the bounds rounded outward, positions in single precision, cells
/// by whole numbers with single precision within; in double precision; btDbvtBroadphase.
[[nodiscard]] std::vector<OriginMethod> originMethods();

/// A world of Bullet's, in single precision, in which balls come to rest.
struct SettleMethod {
    std::string name;
    PhysicsBroadphase broadphase;
    bool shiftsOrigin = false;  // Bullet sees places relative to a whole-numbered origin nearby
};

/// In world coordinates over btDbvtBroadphase and over ours; over ours with the origin shifted.
[[nodiscard]] std::vector<SettleMethod> settleMethods();

struct OriginPlan {
    std::vector<double> offsets;  // 0 first, then powers of two, ascending, up to 2^30 [m]
    std::size_t boxes = 1000;
    std::size_t rays = 50;
};

/// Measures, and says what it shows (origin.sql).
[[nodiscard]] Findings findOrigin(const OriginPlan& plan, std::uint64_t seed,
                                  std::span<const OriginMethod> methods,
                                  std::span<const SettleMethod> settling, const TellProgress& tell);

}  // namespace hashphase::demos
