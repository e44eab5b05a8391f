// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/terrain_workload.hpp>

#include <demos/report/frame_clock.hpp>
#include <demos/scenes/terrain.hpp>
#include <tests/benchmarks/query_workload.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hashphase::benchmarks {
namespace {

constexpr float kAbove = 30;  // [m], where all ask from
constexpr double kTolerance = 0.01;

}  // namespace

HillMesh::HillMesh(std::uint64_t seed) {
    const demos::Terrain hills(seed);
    for (std::uint32_t k = 0; k <= kQuads; ++k) {
        for (std::uint32_t i = 0; i <= kQuads; ++i) {
            const float x = static_cast<float>(i) * kEdge - kHalf;
            const float z = static_cast<float>(k) * kEdge - kHalf;
            vertices_.emplace_back(x, hills.height(x, z), z);
        }
    }
    for (std::uint32_t k = 0; k < kQuads; ++k) {
        for (std::uint32_t i = 0; i < kQuads; ++i) {
            // Along the diagonal that a heightfield of Bullet's takes.
            const std::uint32_t a = k * (kQuads + 1) + i;
            const std::uint32_t b = a + 1;
            const std::uint32_t c = a + kQuads + 1;
            indices_.insert(indices_.end(), {a, c, b, b, c, c + 1});
        }
    }
}

test::RealTriangle HillMesh::triangle(std::uint32_t number) const {
    test::RealTriangle corners;
    for (std::size_t i = 0; i < 3; ++i) {
        corners[i] = vertices_[indices_[3 * number + i]].cast<test::Real>();
    }
    return corners;
}

// On hills without overhangs, a sphere rests where the nearest point of all is the radius away.
double HillMesh::error(const Vector3<float>& center, float radius, float height) const {
    const auto quadAt = [](float x) {
        const float quad = std::floor((x + kHalf) / kEdge);
        return static_cast<std::uint32_t>(std::clamp(quad, 0.0F, static_cast<float>(kQuads - 1)));
    };
    const test::RealPoint at(static_cast<test::Real>(center[0]), static_cast<test::Real>(height),
                             static_cast<test::Real>(center[2]));
    test::Real nearest = std::numeric_limits<test::Real>::infinity();
    for (std::uint32_t k = quadAt(center[2] - radius); k <= quadAt(center[2] + radius); ++k) {
        for (std::uint32_t i = quadAt(center[0] - radius); i <= quadAt(center[0] + radius); ++i) {
            for (const std::uint32_t half : {0U, 1U}) {
                const test::RealTriangle corners = triangle(2 * (k * kQuads + i) + half);
                const auto surface = test::surfaceOf(corners, at);
                if (surface.claim != test::Claim::no && surface.height > at[1] + kTolerance) {
                    return static_cast<double>(surface.height - at[1]);  // sunk in
                }
                nearest = std::min(nearest, (test::nearestPoint(corners, at) - at).norm());
            }
        }
    }
    return static_cast<double>(std::abs(nearest - static_cast<test::Real>(radius)));
}

TerrainWorkload::TerrainWorkload(GroundQuestion question, std::size_t spheres, std::uint64_t seed)
    : question_(question), mesh_(seed), random_(~seed) {
    constexpr float kRoom = HillMesh::kHalf - 2;
    for (std::size_t i = 0; i < spheres; ++i) {
        spheres_.centers.emplace_back(random_.between(-kRoom, kRoom), kAbove,
                                      random_.between(-kRoom, kRoom));
        spheres_.radii.push_back(question == GroundQuestion::rest ? random_.between(0.3F, 1) : 0);
        ways_.emplace_back(random_.between(-0.2F, 0.2F), 0, random_.between(-0.2F, 0.2F));
    }
}

void TerrainWorkload::add(const ContestantKind& kind) {
    entries_.push_back({makeGroundContestant(kind.name, mesh_), kind.onThreads,
                        std::vector<float>(spheres_.centers.size())});
}

void TerrainWorkload::beginFrame() {
    constexpr float kRoom = HillMesh::kHalf - 2;
    for (std::size_t i = 0; i < ways_.size(); ++i) {
        Vector3<float>& center = spheres_.centers[i];
        center += ways_[i];
        for (const int axis : {0, 2}) {
            if (std::abs(center[axis]) > kRoom) {
                ways_[i][axis] = -std::copysign(ways_[i][axis], center[axis]);
            }
        }
    }
}

double TerrainWorkload::runFrame(std::size_t contestant) {
    Entry& entry = entries_[contestant];
    const demos::FrameClock watch(entry.onThreads);
    entry.contestant->ask(question_, spheres_, entry.heights);
    return watch.milliseconds();
}

void TerrainWorkload::listAnswers(std::size_t contestant, std::vector<Answer>& answers) {
    answers.clear();
    const std::vector<float>& heights = entries_[contestant].heights;
    for (std::size_t i = 0; i < heights.size(); ++i) {
        if (!std::isnan(heights[i])) {
            const double error = mesh_.error(spheres_.centers[i], spheres_.radii[i], heights[i]);
            answers.push_back(answerOf(i, error <= kTolerance ? 1 : 2));
        }
    }
}

void TerrainWorkload::listExactAnswers(std::vector<Answer>& answers) {
    answers.clear();
    for (std::size_t i = 0; i < spheres_.centers.size(); ++i) {
        answers.push_back(answerOf(i, 1));
    }
}

Memory TerrainWorkload::memory(std::size_t contestant) const {
    return {std::nullopt, entries_[contestant].contestant->ownBytes()};
}

}  // namespace hashphase::benchmarks
