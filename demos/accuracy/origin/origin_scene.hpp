// SPDX-License-Identifier: Zlib
#pragma once

// A scene of boxes in whole multiples of a unit that is a power of two: wherever it is put, by a
// power of two as well, its coordinates are exact in double precision, and what overlaps what can
// be said exactly, in integers.

#include <demos/accuracy/exact_entry.hpp>

#include <vector>

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

}  // namespace hashphase::demos
