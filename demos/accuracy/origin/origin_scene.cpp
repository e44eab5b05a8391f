// SPDX-License-Identifier: Zlib
#include <demos/accuracy/origin/origin_scene.hpp>

#include <demos/scenes/random.hpp>

#include <cmath>
#include <cstdlib>

namespace hashphase::demos {
namespace {

constexpr std::int64_t kHalfSide = 160 * OriginScene::kStep;  // of where the boxes begin

/// One of low, low + step, ..., high.
std::int64_t multiple(Random& random, std::int64_t low, std::int64_t high, std::int64_t step) {
    const std::int64_t count = (high - low) / step + 1;
    return low + step * static_cast<std::int64_t>(random.unit() * static_cast<float>(count));
}

IntegerPoint pointWithin(Random& random, std::int64_t most, std::int64_t step) {
    IntegerPoint point{};
    for (std::int64_t& coordinate : point) {
        coordinate = multiple(random, -most, most, step);
    }
    return point;
}

}  // namespace

OriginScene::OriginScene(std::size_t boxes, std::size_t rays, std::int64_t finest,
                         std::uint64_t seed) {
    constexpr std::int64_t kSmallest = 4 * kStep;
    constexpr std::int64_t kLargest = 16 * kStep;
    Random random(seed);
    const auto stepOf = [finest](std::size_t i) { return i % 2 == 0 ? kStep : finest; };
    for (std::size_t i = 0; i < boxes; ++i) {
        IntegerBox& box = boxes_.emplace_back();
        box.centre = pointWithin(random, kHalfSide, stepOf(i));
        for (std::int64_t& half : box.half) {
            half = multiple(random, kSmallest, kLargest, stepOf(i));
        }
        velocities_.push_back(pointWithin(random, kStep, stepOf(i)));
    }
    for (std::size_t i = 0; i < rays; ++i) {
        rays_.push_back({pointWithin(random, 2 * kHalfSide, stepOf(i)),
                         pointWithin(random, 2 * kHalfSide, stepOf(i))});
    }
}

void OriginScene::advance() {
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            std::int64_t& place = boxes_[i].centre[axis];
            std::int64_t& velocity = velocities_[i][axis];
            velocity = std::abs(place + velocity) > kHalfSide ? -velocity : velocity;
            place += velocity;
        }
    }
}

bool overlapExactly(const IntegerBox& a, const IntegerBox& b) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (std::abs(a.centre[axis] - b.centre[axis]) > a.half[axis] + b.half[axis]) {
            return false;
        }
    }
    return true;
}

// The theorem of separating axes: the axes of the box, and those across each of them and the segment.
// Everything is doubled, so that the middle of the segment is whole.
bool meetExactly(const IntegerRay& ray, const IntegerBox& box) {
    IntegerPoint way{};     // half the segment, doubled
    IntegerPoint apart{};   // from the box's centre to the segment's, doubled
    IntegerPoint extent{};  // half the box, doubled
    for (std::size_t axis = 0; axis < 3; ++axis) {
        way[axis] = ray.to[axis] - ray.from[axis];
        apart[axis] = ray.from[axis] + ray.to[axis] - 2 * box.centre[axis];
        extent[axis] = 2 * box.half[axis];
        if (std::abs(apart[axis]) > extent[axis] + std::abs(way[axis])) {
            return false;
        }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t j = (axis + 1) % 3;
        const std::size_t k = (axis + 2) % 3;
        if (std::abs(way[j] * apart[k] - way[k] * apart[j]) >
            extent[j] * std::abs(way[k]) + extent[k] * std::abs(way[j])) {
            return false;
        }
    }
    return true;
}

}  // namespace hashphase::demos
