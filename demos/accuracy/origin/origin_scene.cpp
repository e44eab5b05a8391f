// SPDX-License-Identifier: Zlib
#include <demos/accuracy/origin/origin_experiment.hpp>

#include <demos/scenes/random.hpp>

#include <cstdlib>

namespace hashphase::demos {
namespace {

constexpr std::int64_t kHalfSide = 160 * OriginScene::kStep;  // of where the boxes begin

/// One of low, low + step, ..., high.
std::int64_t multiple(Random& random, std::int64_t low, std::int64_t high, std::int64_t step) {
    const std::int64_t count = (high - low) / step + 1;
    return low + step * static_cast<std::int64_t>(random.unit() * static_cast<float>(count));
}

WholePoint pointWithin(Random& random, std::int64_t most, std::int64_t step) {
    WholePoint point{};
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

bool meetExactly(const IntegerRay& ray, const IntegerBox& box) {
    WholePoint way;
    WholePoint low;
    WholePoint high;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        way[axis] = ray.to[axis] - ray.from[axis];
        low[axis] = box.centre[axis] - box.half[axis] - ray.from[axis];
        high[axis] = box.centre[axis] + box.half[axis] - ray.from[axis];
    }
    return exactEntry(way, low, high).has_value();
}

}  // namespace hashphase::demos
