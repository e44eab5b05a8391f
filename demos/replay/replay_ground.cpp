// SPDX-License-Identifier: Zlib
#include <demos/replay/replay_ground.hpp>

#include <demos/report/base64.hpp>

#include <algorithm>
#include <cmath>

namespace hashphase::demos {
namespace {

constexpr float kSquaresAlongTheLongerSide = 128;
constexpr float kHeightSteps = 255;

/// Of lattice points along a side.
std::size_t pointsAlong(float side, float longer) {
    const long squares = std::lround(kSquaresAlongTheLongerSide * side / longer);
    return static_cast<std::size_t>(std::max(1L, squares)) + 1;
}

}  // namespace

ReplayGround sampleGround(const GroundHeight& heightAt, const Aabb<float>& bounds) {
    const Vector3<float> sides = bounds.sizes();
    if (!heightAt || !(std::min(sides.x(), sides.z()) > 0)) {
        return {};
    }
    const float longer = std::max(sides.x(), sides.z());
    ReplayGround ground;
    ground.columns = pointsAlong(sides.x(), longer);
    ground.rows = pointsAlong(sides.z(), longer);
    const auto place = [&bounds](int axis, std::size_t i, std::size_t count) {
        return std::lerp(bounds.min()[axis], bounds.max()[axis],
                         static_cast<float>(i) / static_cast<float>(count - 1));
    };
    std::vector<float> heights;
    for (std::size_t k = 0; k < ground.rows; ++k) {
        for (std::size_t i = 0; i < ground.columns; ++i) {
            heights.push_back(heightAt(place(0, i, ground.columns), place(2, k, ground.rows)));
        }
    }
    const auto [lowest, highest] = std::ranges::minmax(heights);
    ground.lowest = lowest;
    ground.highest = highest;
    for (const float height : heights) {
        const float share = highest > lowest ? (height - lowest) / (highest - lowest) : 0;
        ground.heights.push_back(static_cast<std::uint8_t>(std::lround(share * kHeightSteps)));
    }
    return ground;
}

Json groundJson(const ReplayGround& ground) {
    if (ground.columns == 0) {
        return nullptr;
    }
    return {{"columns", ground.columns},
            {"rows", ground.rows},
            {"lowest", ground.lowest},
            {"highest", ground.highest},
            {"heights", base64(ground.heights)}};
}

}  // namespace hashphase::demos
