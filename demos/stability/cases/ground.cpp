// SPDX-License-Identifier: Zlib
//
// Ground: points on the edges that triangles share, and triangles that are hardly any.

#include <demos/stability/cases/cases.hpp>

#include <integration/terrain/terrain.hpp>

#include <array>

namespace hashphase::demos {
namespace {

// A square of 1 m quads, each cut along the diagonal from (0, 0) to (1, 1), heights multiples of 1/16.
template <class Scalar>
class Hills {
public:
    using Point = Vector3<Scalar>;
    static constexpr int kQuads = 48;

    explicit Hills(std::uint64_t seed) {
        Random random(seed);
        for (int i = 0; i < (kQuads + 1) * (kQuads + 1); ++i) {
            heights_.push_back(std::floor(random.between(0, 64)) / 16);
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

    [[nodiscard]] Scalar height(int x, int z) const {
        return heights_[static_cast<std::size_t>(z * (kQuads + 1) + x)];
    }
    [[nodiscard]] Point vertex(int x, int z) const {
        return {static_cast<Scalar>(x), height(x, z), static_cast<Scalar>(z)};
    }

    std::vector<Point> corners;  // three a triangle

private:
    std::vector<Scalar> heights_;
};

// Triangles that have no height below any point, or say nothing new.
template <class Scalar>
void addOddTriangles(Hills<Scalar>& hills) {
    using Point = Vector3<Scalar>;
    const Point a = hills.vertex(3, 3);
    const Point b = hills.vertex(4, 3);
    std::vector<Point> corners{a, a, a,                                                // a point
                               a, b, b,                                                // an edge
                               a, b, Point(Scalar(0.5) * (a + b)),                     // no area
                               a, b, Point(a - Point(0, 3, 0))};                       // vertical
    corners.insert(corners.end(), hills.corners.begin(), hills.corners.begin() + 30);  // twice
    hills.corners.insert(hills.corners.end(), corners.begin(), corners.end());
}

template <class Scalar>
struct Probe {
    Vector3<Scalar> from;
    double height;  // of the ground below
};

// Points above edges of all three directions and above vertices, exactly.
template <class Scalar>
std::vector<Probe<Scalar>> probesOnEdges(const Hills<Scalar>& hills, int count,
                                         std::uint64_t seed) {
    Random random(seed);
    const auto below = [&](std::uint32_t limit) {
        return static_cast<int>(indexBelow(random, limit));
    };
    std::vector<Probe<Scalar>> probes;
    for (int i = 0; i < count; ++i) {
        const std::array<int, 2> along = std::array<std::array<int, 2>, 3>{
            {{1, 0}, {0, 1}, {1, 1}}}[static_cast<std::size_t>(i % 3)];
        const int x = below(Hills<Scalar>::kQuads);
        const int z = below(Hills<Scalar>::kQuads);
        const Scalar share = i % 10 == 0 ? Scalar(0) : static_cast<Scalar>(below(4096)) / 4096;
        const auto low = static_cast<double>(hills.height(x, z));
        const auto high = static_cast<double>(hills.height(x + along[0], z + along[1]));
        probes.push_back({{static_cast<Scalar>(x) + share * static_cast<Scalar>(along[0]), 100,
                           static_cast<Scalar>(z) + share * static_cast<Scalar>(along[1])},
                          low + static_cast<double>(share) * (high - low)});
    }
    return probes;
}

// Compares what below(point) finds; heights may be off by as much as a ray of 110 m rounds.
template <class Scalar, class Below>
void judgeGround(CaseRun<Scalar>& run, const std::vector<Probe<Scalar>>& probes,
                 const Below& below) {
    constexpr double kRounding = 1e-3;
    Objects all;
    Objects found;
    for (std::uint32_t i = 0; i < probes.size(); ++i) {
        all.push_back(i);
        const std::optional<double> height = below(probes[i].from);
        if (height && std::abs(*height - probes[i].height) <= kRounding) {
            found.push_back(i);
        }
    }
    run.compare(found, all);
    for (const Vector3<double>& outside :
         {Vector3<double>(-0.001, 50, 5), Vector3<double>(1e6, 50, 5),
          Vector3<double>(5, 50, 48.001), Vector3<double>(5, -5, 5)}) {
        run.expect(!below(outside.cast<Scalar>()),
                   "no ground is found outside the terrain, or from below it");
    }
}

constexpr auto ground = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    using Point = Vector3<Scalar>;
    const bool isBulletsWay = run.name == "dbvt";
    if (!run.isOurs && !isBulletsWay) {
        return;
    }
    Hills<Scalar> hills(run.seed);
    addOddTriangles(hills);
    const int count = run.quickOrFull(20'000, 1'000'000);
    const std::vector<Probe<Scalar>> probes = probesOnEdges(hills, count, run.seed);
    if (isBulletsWay) {
        judgeGround(run, probes, run.make({worldOf<Scalar>({}), 0})->groundOf(hills.corners));
        run.note(
            "The query is a vertical ray through a btBvhTriangleMeshShape; no broadphase is used.");
        return;
    }
    Grid<Scalar> grid;
    Terrain<Scalar> terrain(grid);
    terrain.add(hills.corners);
    const std::array bad{Point(0, 0, 0), Point(kNan<Scalar>, 0, 0), Point(0, 0, 1)};
    run.expect(terrain.add(bad).refused.size() == 1, "a triangle with NaN is refused and listed");
    judgeGround(run, probes, [&](const Point& point) -> std::optional<double> {
        const auto below = terrain.surfaceBelow(point);
        return below ? std::optional(static_cast<double>(below->height)) : std::nullopt;
    });
    for (const Point& nowhere : {Point(kNan<Scalar>, 0, 0), Point(0, kNan<Scalar>, 0)}) {
        run.expect(!terrain.surfaceBelow(nowhere), "no ground is found below a point with NaN");
    }
};

constexpr HardCase kGroundCases[] = {
    {"H40", "points on the edges of triangles",
     "a million points (--quick: 20,000) exactly above edges, diagonals and corners of 4,608 "
     "triangles; also four degenerate triangles (a point, an edge, three points on a line, a "
     "vertical triangle), ten triangles added twice, and points outside; for hashphase also a "
     "triangle with NaN",
     "the ground below each point, at its height; no ground outside the terrain, or for a point "
     "below it",
     ground},
};

}  // namespace

std::span<const HardCase> groundCases() {
    return kGroundCases;
}

}  // namespace hashphase::demos
