// SPDX-License-Identifier: Zlib

// What does it cost to dig? In every frame a hole or a mound of 288 triangles is made somewhere in hills of 51,200.
// Who digs: Terrain, by what has changed and all anew; and Bullet's shapes.
//
// Answers   As of `terrain`: the ground below a point beside each vertex that was dug, asked after the frame.

#include <demos/scenes/random.hpp>
#include <integration/terrain/terrain.hpp>
#include <tests/benchmarks/hill_ground.hpp>

#include <memory>
#include <span>

namespace hashphase::benchmarks {
namespace {

/// The hills, and what was dug last.
struct Site {
    HillMesh mesh;
    DugHills dug = {};
};

class TerrainDug {
public:
    explicit TerrainDug(const HillMesh& mesh) { addAll(mesh); }

    void dig(const HillMesh& mesh, const DugHills& dug) {
        const std::span<const std::uint32_t> indices = mesh.indices();
        for (const auto& [first, count] : dug.triangles) {
            terrain_.replace(first, mesh.vertices(),
                             indices.subspan(3 * std::size_t{first}, 3 * std::size_t{count}));
        }
        grid_.update();
    }
    [[nodiscard]] std::optional<float> heightBelow(const Vector3<float>& point) const {
        const auto ground = terrain_.surfaceBelow(point);
        return ground ? std::optional(ground->height) : std::nullopt;
    }
    [[nodiscard]] std::optional<OwnBytes> ownBytes() const {
        return OwnBytes{grid_.memoryBytes() + terrain_.memoryBytes(), 0};
    }

protected:
    void addAll(const HillMesh& mesh) {
        terrain_.clear();
        terrain_.add(mesh.vertices(), mesh.indices());
        grid_.update();
    }

private:
    Grid<float> grid_;
    Terrain<float> terrain_{grid_};
};

struct TerrainAnew : TerrainDug {
    using TerrainDug::TerrainDug;
    void dig(const HillMesh& mesh, const DugHills& /*dug*/) { addAll(mesh); }
};

/// A shape of Bullet's.
template <class Shape>
struct ShapeDug : Shape {
    using Shape::Shape;
    [[nodiscard]] std::optional<float> heightBelow(const Vector3<float>& point) {
        constexpr btScalar below = -20;
        const btVector3 from = toBullet(point);
        const btScalar fraction =
            Shape::fractionOf(from, btVector3(from.x(), below, from.z()), btScalar(0));
        return fraction < 1 ? std::optional(from.y() + fraction * (below - from.y()))
                            : std::nullopt;
    }
    [[nodiscard]] static std::optional<OwnBytes> ownBytes() { return std::nullopt; }
};

template <class Ground>
class Digger final : public Runner {
public:
    explicit Digger(const Site& site) : site_(site), ground_(site.mesh) {}

    void run() override { ground_.dig(site_.mesh, site_.dug); }

    void listAnswers(std::vector<Answer>& answers) override {
        answers.clear();
        for (const std::uint32_t vertex : site_.dug.vertices) {
            const Vector3<float> point =
                site_.mesh.vertices()[vertex] + Vector3<float>(0.7F, 20, 0.4F);
            if (const std::optional<float> height = ground_.heightBelow(point)) {
                const double error = site_.mesh.error(point, 0, *height);
                answers.push_back(answerOf(vertex, error <= HillMesh::kTolerance ? 1 : 2));
            }
        }
    }
    [[nodiscard]] std::optional<OwnBytes> ownBytes() const override { return ground_.ownBytes(); }

private:
    const Site& site_;
    Ground ground_;
};

class DiggingWorkload final : public Workload {
public:
    explicit DiggingWorkload(std::uint64_t seed) : site_{HillMesh(seed)}, random_(~seed) {}

    [[nodiscard]] std::unique_ptr<Runner> make(const ContestantKind& kind) override {
        if (kind.name == kBaseline) {
            return std::make_unique<Digger<ShapeDug<MeshGround>>>(site_);
        }
        if (kind.name == "heightfield") {
            return std::make_unique<Digger<ShapeDug<HeightfieldGround>>>(site_);
        }
        if (kind.name == "hash-anew") {
            return std::make_unique<Digger<TerrainAnew>>(site_);
        }
        return std::make_unique<Digger<TerrainDug>>(site_);
    }

    void beginFrame() override {
        constexpr float room = HillMesh::kQuads - HillMesh::kDugQuads - 1;
        const auto quad = [&] { return static_cast<std::uint32_t>(random_.between(0, room)); };
        const std::uint32_t i = quad();
        const std::uint32_t k = quad();
        site_.dug = site_.mesh.dig(i, k, random_.between(-3, 3));
    }

    void listExactAnswers(std::vector<Answer>& answers) override {
        answers.clear();
        for (const std::uint32_t vertex : site_.dug.vertices) {
            answers.push_back(answerOf(vertex, 1));
        }
    }

    [[nodiscard]] std::size_t objects() const override { return site_.mesh.indices().size() / 3; }
    [[nodiscard]] std::size_t operations() const override {
        return 2 * std::size_t{HillMesh::kDugQuads} * HillMesh::kDugQuads;
    }

private:
    Site site_;
    demos::Random random_;
};

}  // namespace

Benchmark terrainEditBenchmark() {
    Benchmark benchmark{.name = "terrain-edit",
                        .group = "queries",
                        .description = "288 of 51,200 triangles change",
                        .operation = "triangle",
                        .sizes = {2 * std::size_t{HillMesh::kQuads} * HillMesh::kQuads},
                        .takesOtherSizes = false};
    benchmark.contestants = [](std::size_t, std::uint64_t) {
        const std::string& bullet = contestantKind(kBaseline).package;
        return std::vector<ContestantKind>{
            {.name = "hash", .title = "Terrain::replace()", .ours = true},
            {.name = "hash-anew", .title = "Terrain::clear() and add() of all", .ours = true},
            {.name = std::string(kBaseline),
             .title = "btBvhTriangleMeshShape::partialRefitTree()",
             .package = bullet},
            {.name = "heightfield",
             .title = "btHeightfieldTerrainShape::buildAccelerator()",
             .package = bullet}};
    };
    benchmark.make = [](std::size_t /*objects*/, std::uint64_t seed) {
        return std::make_unique<DiggingWorkload>(seed);
    };
    return benchmark;
}

}  // namespace hashphase::benchmarks
