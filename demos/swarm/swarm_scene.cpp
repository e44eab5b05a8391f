// SPDX-License-Identifier: Zlib
#include <demos/swarm/swarm_scene.hpp>

#include <integration/distributed/global_id.hpp>

#include <array>
#include <cmath>

namespace hashphase::demos {
namespace {

constexpr std::array kKinds{
    SwarmKindName{SwarmKind::uniform, "uniform", "spread evenly over a cube"},
    SwarmKindName{SwarmKind::clusters, "clusters", "nearly all in eight balls of different sizes"},
    SwarmKindName{SwarmKind::traveller, "traveller",
                  "half of them in a ball that crosses the cube"},
    SwarmKindName{SwarmKind::corner, "corner", "all in a corner, but for one far away"},
    SwarmKindName{SwarmKind::sizes, "sizes", "radii of 1 mm to 10 m, and three planes of 1e18 m"},
};

constexpr float kRadius = 0.5F;       // [m]
constexpr float kSpacing = 2;         // [m] between homes: half a pair for each sphere
constexpr float kWander = 3;          // [m] to either side of home
constexpr float kFramesAround = 200;  // until a sphere is where it was
constexpr float kTravelFrames = 300;  // in which a traveller crosses the cube
constexpr std::uint64_t kPlanes = 3;

using detail::mixedBits;

// Takes 21 bits, 0 <= result < 1.
float unit(std::uint64_t bits, int from) {
    return static_cast<float>((bits >> from) & 0x1fffff) * 0x1p-21F;
}

Vector3<float> pointOf(std::uint64_t bits) {
    return {unit(bits, 0), unit(bits, 21), unit(bits, 42)};
}

// A triangle wave from -1 to 1: arithmetic that is the same everywhere, as sines are not.
float wave(float turns) {
    return 4 * std::abs(turns - std::floor(turns + 0.5F)) - 1;
}

}  // namespace

std::span<const SwarmKindName> swarmKinds() {
    return kKinds;
}

SwarmScene::SwarmScene(SwarmKind kind, std::uint64_t count, std::uint64_t seed)
    : kind_(kind),
      count_(count),
      seed_(mixedBits(seed)),
      side_(kSpacing * std::cbrt(static_cast<float>(count))) {}

// Homes of a ball are as dense as those of the cube.
Vector3<float> SwarmScene::home(std::uint64_t number, std::uint64_t bits) const {
    const Vector3<float> point = pointOf(bits);
    switch (kind_) {
        case SwarmKind::clusters: {
            const std::uint64_t cluster = number % 10;
            if (cluster < 8) {
                const Vector3<float> corner = pointOf(mixedBits(seed_ + cluster));
                const float size = 0.16F * side_ * (0.4F + 0.15F * static_cast<float>(cluster));
                return 0.75F * side_ * corner + size * point;
            }
            return side_ * point;
        }
        case SwarmKind::traveller:
            return number % 2 == 0 ? Vector3<float>(0.4F * side_ * point)
                                   : Vector3<float>(side_ * point);
        case SwarmKind::corner:
            return number + 1 == count_ ? Vector3<float>::Constant(1e6F)
                                        : Vector3<float>(0.9F * side_ * point);
        default:
            return side_ * point;
    }
}

Aabb<float> SwarmScene::box(std::uint64_t number, std::uint32_t frame) const {
    if (kind_ == SwarmKind::sizes && number < kPlanes) {
        constexpr float kFar = 1e18F;
        Aabb<float> plane(Vector3<float>::Constant(-kFar), Vector3<float>::Constant(kFar));
        const auto axis = static_cast<Eigen::Index>(number);
        plane.min()[axis] = side_ / 2;
        plane.max()[axis] = side_ / 2 + kRadius;
        return plane;
    }
    const std::uint64_t bits = mixedBits(seed_ ^ mixedBits(number));
    const std::uint64_t more = mixedBits(bits);
    Vector3<float> center = home(number, bits);
    const float turns = static_cast<float>(frame) / kFramesAround;
    for (int axis = 0; axis < 3; ++axis) {
        center[axis] += kWander * wave(turns + unit(more, 21 * axis));
    }
    if (kind_ == SwarmKind::traveller && number % 2 == 0) {
        const float way = (wave(static_cast<float>(frame) / (2 * kTravelFrames)) + 1) / 2;
        center += Vector3<float>(0.6F * side_ * way, 0.3F * side_, 0.3F * side_);
    }
    float radius = kRadius;
    if (kind_ == SwarmKind::sizes) {
        // Of a radius of r or more there are as many as 1 / r.
        const float chance = unit(mixedBits(more), 0);
        radius = 1e-3F / (1e-4F + (1 - 1e-4F) * chance);
    }
    return {center - Vector3<float>::Constant(radius), center + Vector3<float>::Constant(radius)};
}

}  // namespace hashphase::demos
