// SPDX-License-Identifier: Zlib
//
// Ground: points on the edges that triangles share, and triangles that are hardly any.

#include <demos/stability/cases/cases.hpp>

#include <demos/scenes/random.hpp>
#include <demos/stability/pair_scene.hpp>
#include <integration/bullet/conversions.hpp>
#include <integration/terrain/terrain.hpp>

#include <BulletCollision/NarrowPhaseCollision/btRaycastCallback.h>
#include <btBulletCollisionCommon.h>

#include <array>
#include <cmath>
#include <limits>

namespace hashphase::demos {
namespace {

using Point = Vector3<float>;

// A square of 1 m quads, each cut along the diagonal from (0, 0) to (1, 1), heights multiples of 1/16.
class Hills {
public:
    static constexpr int kQuads = 48;

    explicit Hills(std::uint64_t seed) {
        Random random(seed);
        for (int z = 0; z <= kQuads; ++z) {
            for (int x = 0; x <= kQuads; ++x) {
                heights_.push_back(std::floor(random.between(0, 64)) / 16);
            }
        }
        for (int z = 0; z < kQuads; ++z) {
            for (int x = 0; x < kQuads; ++x) {
                for (const std::array<int, 2>& corner :
                     {std::array{0, 0}, {0, 1}, {1, 1}, {0, 0}, {1, 1}, {1, 0}}) {
                    corners.push_back(vertex(x + corner[0], z + corner[1]));
                }
            }
        }
    }

    [[nodiscard]] float height(int x, int z) const {
        return heights_[static_cast<std::size_t>(z * (kQuads + 1) + x)];
    }
    [[nodiscard]] Point vertex(int x, int z) const {
        return {static_cast<float>(x), height(x, z), static_cast<float>(z)};
    }

    std::vector<Point> corners;  // three a triangle

private:
    std::vector<float> heights_;
};

// Triangles that have no height below any point, or say nothing new.
std::vector<Point> oddTriangles(const Hills& hills) {
    const Point a = hills.vertex(3, 3);
    const Point b = hills.vertex(4, 3);
    std::vector<Point> corners{a, a, a,                                                // a point
                               a, b, b,                                                // an edge
                               a, b, Point(0.5F * (a + b)),                            // no area
                               a, b, Point(a - Point(0, 3, 0))};                       // vertical
    corners.insert(corners.end(), hills.corners.begin(), hills.corners.begin() + 30);  // twice
    return corners;
}

struct Probe {
    Point from;
    double height;  // of the ground below
};

// Points above edges of all three directions and above vertices, exactly.
std::vector<Probe> probesOnEdges(const Hills& hills, int count, std::uint64_t seed) {
    Random random(seed);
    const auto below = [&](int limit) {
        return std::min(static_cast<int>(random.unit() * static_cast<float>(limit)), limit - 1);
    };
    std::vector<Probe> probes;
    for (int i = 0; i < count; ++i) {
        const std::array<int, 2> along = std::array<std::array<int, 2>, 3>{
            {{1, 0}, {0, 1}, {1, 1}}}[static_cast<std::size_t>(i % 3)];
        const int x = below(Hills::kQuads);
        const int z = below(Hills::kQuads);
        const float share = i % 10 == 0 ? 0.0F : static_cast<float>(below(4096)) / 4096;
        const double low = static_cast<double>(hills.height(x, z));
        const double high = static_cast<double>(hills.height(x + along[0], z + along[1]));
        probes.push_back({Point(static_cast<float>(x) + share * static_cast<float>(along[0]), 100,
                                static_cast<float>(z) + share * static_cast<float>(along[1])),
                          low + static_cast<double>(share) * (high - low)});
    }
    return probes;
}

struct NearestHit final : btTriangleRaycastCallback {
    using btTriangleRaycastCallback::btTriangleRaycastCallback;
    btScalar reportHit(const btVector3& /*normal*/, btScalar fraction, int /*part*/,
                       int /*index*/) override {
        return fraction;
    }
};

// Bullet's way: a ray down through a mesh.
class BulletGround {
public:
    explicit BulletGround(const std::vector<Point>& corners) {
        for (std::size_t i = 0; i < corners.size(); i += 3) {
            mesh_.addTriangle(toBullet(corners[i]), toBullet(corners[i + 1]),
                              toBullet(corners[i + 2]));
        }
        shape_ = std::make_unique<btBvhTriangleMeshShape>(&mesh_, true);
    }

    [[nodiscard]] std::optional<double> below(const Point& point) const {
        const btVector3 from = toBullet(point);
        const btVector3 to(from.x(), -10, from.z());
        NearestHit hit(from, to);
        shape_->performRaycast(&hit, from, to);
        if (hit.m_hitFraction >= 1) {
            return std::nullopt;
        }
        return static_cast<double>(from.y()) -
               static_cast<double>(hit.m_hitFraction) * static_cast<double>(from.y() + 10);
    }

private:
    btTriangleMesh mesh_;
    std::unique_ptr<btBvhTriangleMeshShape> shape_;
};

// Compares what below(point) finds; heights may be off by as much as a ray of 110 m rounds.
template <class Below>
void judgeGround(CaseTally& tally, const std::vector<Probe>& probes, const Below& below) {
    constexpr double kRounding = 1e-3;
    std::vector<std::size_t> all;
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < probes.size(); ++i) {
        all.push_back(i);
        const std::optional<double> height = below(probes[i].from);
        if (height && std::abs(*height - probes[i].height) <= kRounding) {
            found.push_back(i);
        }
    }
    tally.compare(found, all);
    for (const Point& outside :
         {Point(-0.001F, 50, 5), Point(1e6F, 50, 5), Point(5, 50, 48.001F), Point(5, -5, 5)}) {
        tally.expect(!below(outside), "there is no ground outside and below");
    }
}

CaseOutcome ground(const CaseContext& context) {
    const bool isBulletsWay = context.kind.name == "dbvt";
    if (!context.kind.ours && !isBulletsWay) {
        return {};
    }
    const Hills hills(context.seed);
    std::vector<Point> corners = hills.corners;
    const std::vector<Point> odd = oddTriangles(hills);
    corners.insert(corners.end(), odd.begin(), odd.end());
    const int count = context.quickOrFull(20'000, 1'000'000);
    const std::vector<Probe> probes = probesOnEdges(hills, count, context.seed);
    CaseTally tally;
    if (isBulletsWay) {
        const BulletGround bullet(corners);
        judgeGround(tally, probes, [&](const Point& point) { return bullet.below(point); });
        tally.note("A ray down through a btBvhTriangleMeshShape, under any broadphase.");
        return tally.outcome();
    }
    Grid<float> grid;
    Terrain<float> terrain(grid);
    terrain.add(corners);
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    const std::array bad{Point(0, 0, 0), Point(kNan, 0, 0), Point(0, 0, 1)};
    tally.expect(terrain.add(bad).refused.size() == 1, "a triangle with NaN is refused and named");
    judgeGround(tally, probes, [&](const Point& point) -> std::optional<double> {
        const auto below = terrain.surfaceBelow(point);
        return below ? std::optional(static_cast<double>(below->height)) : std::nullopt;
    });
    for (const Point& nowhere : {Point(kNan, 0, 0), Point(0, kNan, 0)}) {
        tally.expect(!terrain.surfaceBelow(nowhere), "there is no ground below NaN");
    }
    return tally.outcome();
}

constexpr std::array kGroundCases{
    HardCase{
        "H40", "points on the edges of triangles",
        "a million points (--quick: 20,000) exactly on edges, diagonals and corners of 4,608 "
        "triangles; among these a point, an edge, one without area, a vertical one, ten twice; "
        "points outside; in ours one with NaN",
        "ground below each point on an edge, at its height; none outside", ground},
};

}  // namespace

std::span<const HardCase> groundCases() {
    return kGroundCases;
}

}  // namespace hashphase::demos
