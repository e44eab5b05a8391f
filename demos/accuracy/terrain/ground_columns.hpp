// SPDX-License-Identifier: Zlib
#pragma once

// The paper's grid: columns of 1 m x 1 m over the ground (x, z), hashed, with lists of what is in
// them, and its ways to choose columns for what moves.

#include <broadphase/moving_box.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

namespace hashphase::demos {

struct Column {
    std::int32_t x = 0;
    std::int32_t z = 0;

    friend bool operator==(const Column&, const Column&) = default;
};

[[nodiscard]] inline std::int32_t columnAt(double coordinate) {
    return static_cast<std::int32_t>(std::floor(coordinate));
}

/// All columns of a box.
template <class Visit>
void visitBox(const Aabb<float>& box, const Visit& visit) {
    const std::int32_t firstX = columnAt(static_cast<double>(box.min().x()));
    const std::int32_t lastX = columnAt(static_cast<double>(box.max().x()));
    const std::int32_t lastZ = columnAt(static_cast<double>(box.max().z()));
    for (Column at{firstX, columnAt(static_cast<double>(box.min().z()))}; at.z <= lastZ; ++at.z) {
        for (at.x = firstX; at.x <= lastX; ++at.x) {
            visit(at);
        }
    }
}

/// The line raster of the paper, after J. E. Bresenham, "Algorithm for Computer Control of a Digital
/// Plotter", 1965: from the column of the centre at the start to that at the end.
template <class Visit>
void visitThinLine(const MovingBox<float>& moving, const Visit& visit) {
    const Vector3<double> start = moving.box.center().cast<double>();
    const Vector3<double> end = start + moving.displacement.cast<double>();
    Column at{columnAt(start.x()), columnAt(start.z())};
    const Column last{columnAt(end.x()), columnAt(end.z())};
    const std::int32_t farX = std::abs(last.x - at.x);
    const std::int32_t farZ = std::abs(last.z - at.z);
    const std::int32_t stepX = last.x < at.x ? -1 : 1;
    const std::int32_t stepZ = last.z < at.z ? -1 : 1;
    std::int32_t error = farX - farZ;
    for (visit(at); !(at == last); visit(at)) {
        const std::int32_t twice = 2 * error;
        if (twice > -farZ) {
            error -= farZ;
            at.x += stepX;
        }
        if (twice < farX) {
            error += farX;
            at.z += stepZ;
        }
    }
}

/// All columns that the box touches on its way: row by row those between where it is when it enters
/// the row and where it is when it leaves, and a hair more.
template <class Visit>
void visitThickLine(const MovingBox<float>& moving, const Visit& visit) {
    constexpr double kHair = 1e-9;  // [m]; rounding is less
    const Aabb<double> box = moving.box.cast<double>();
    const Vector3<double> way = moving.displacement.cast<double>();
    const double lowest = box.min().x() + std::min(way.x(), 0.0);
    const double highest = box.max().x() + std::max(way.x(), 0.0);
    const auto timeAt = [&](double distance) {
        return way.x() == 0 ? 0 : std::clamp(distance / way.x(), 0.0, 1.0);
    };
    for (Column at{columnAt(lowest - kHair)}; at.x <= columnAt(highest + kHair); ++at.x) {
        double enters = timeAt(at.x - box.max().x());
        double leaves = way.x() == 0 ? 1 : timeAt(at.x + 1 - box.min().x());
        if (way.x() < 0) {
            enters = timeAt(at.x + 1 - box.min().x());
            leaves = timeAt(at.x - box.max().x());
        }
        const auto [low, high] = std::minmax({enters * way.z(), leaves * way.z()});
        const std::int32_t lastZ = columnAt(box.max().z() + high + kHair);
        for (at.z = columnAt(box.min().z() + low - kHair); at.z <= lastZ; ++at.z) {
            visit(at);
        }
    }
}

/// Which objects are in which columns. What is filed first stays; what is filed after keepFiled()
/// lasts until unfile().
class GroundColumns {
public:
    explicit GroundColumns(std::size_t expected);

    void file(const Column& column, std::uint32_t object);

    /// visit(object), for all that are in the column.
    template <class Visit>
    void visitObjects(const Column& column, const Visit& visit) const {
        for (std::uint32_t i = heads_[bucketOf(column)]; i != kNone; i = entries_[i].next) {
            if (entries_[i].column == column) {
                visit(entries_[i].object);
            }
        }
    }

    void keepFiled() { kept_ = entries_.size(); }
    void unfile();

private:
    void grow();

    static constexpr std::uint32_t kNone = ~std::uint32_t{0};

    struct Entry {
        Column column;
        std::uint32_t object;
        std::uint32_t next;
    };

    [[nodiscard]] std::size_t bucketOf(const Column& column) const noexcept {
        // Neighbours along x stay neighbours; a large odd number takes rows far apart.
        const std::uint32_t row = static_cast<std::uint32_t>(column.z) * 0x9e3779b1U;
        return (static_cast<std::uint32_t>(column.x) + row) & (heads_.size() - 1);
    }

    std::vector<std::uint32_t> heads_;  // a power of two, no fewer than entries
    std::vector<Entry> entries_;
    std::size_t kept_ = 0;
};

}  // namespace hashphase::demos
