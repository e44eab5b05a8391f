// SPDX-License-Identifier: Zlib

// Where on the ground is everybody? Spheres roam over hills of triangles; in every frame all of them
// move, and each asks for the height of the ground below, or for the height at which it rests. Who
// answers: ours one by one, in a batch and on threads; Bullet's world, and its shapes by themselves.
//
// Answers   1 where the height is the exact one, but for 1 cm, else 2. Exact is what the nearest
//           points of all triangles around say, in long double.

#include <demos/scenes/random.hpp>
#include <integration/bullet/conversions.hpp>
#include <integration/terrain/terrain.hpp>
#include <tests/benchmarks/hill_ground.hpp>
#include <tests/benchmarks/peers/peers.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace hashphase::benchmarks {
namespace {

constexpr float kAbove = 30;  // [m], where all ask from
constexpr float kBelow = -5;  // [m], where rays and sweeps end
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

enum class GroundQuestion : std::uint8_t { surface, rest };

/// Everybody's place and size in a frame, and what is asked.
struct Spheres {
    GroundQuestion question;
    HillMesh mesh;
    std::vector<Vector3<float>> centers = {};
    std::vector<float> radii = {};
};

// --- Who answers -----------------------------------------------------------------------------------

class GroundRunner : public Runner {
public:
    explicit GroundRunner(const Spheres& spheres)
        : spheres_(spheres), heights_(spheres.centers.size()) {}

    void listAnswers(std::vector<Answer>& answers) override {
        answers.clear();
        for (std::size_t i = 0; i < heights_.size(); ++i) {
            if (!std::isnan(heights_[i])) {
                const double error =
                    spheres_.mesh.error(spheres_.centers[i], spheres_.radii[i], heights_[i]);
                answers.push_back(answerOf(i, error <= HillMesh::kTolerance ? 1 : 2));
            }
        }
    }

protected:
    const Spheres& spheres_;
    std::vector<float> heights_;  // NaN for none
};

enum class Way : std::uint8_t { oneByOne, batch, threads };

class OwnGround final : public GroundRunner {
public:
    OwnGround(const Spheres& spheres, Way way) : GroundRunner(spheres), terrain_(grid_), way_(way) {
        terrain_.add(spheres.mesh.vertices(), spheres.mesh.indices());
        grid_.update();
    }

    void run() override {
        const auto& [question, mesh, centers, radii] = spheres_;
        found_.resize(centers.size());
        if (way_ == Way::oneByOne) {
            for (std::size_t i = 0; i < centers.size(); ++i) {
                found_[i] = question == GroundQuestion::surface
                                ? terrain_.surfaceBelow(centers[i])
                                : terrain_.restingHeight(centers[i], radii[i]);
            }
        } else {
            const ParallelFor loop =
                way_ == Way::threads ? *threadedLoop() : ParallelFor(serialFor);
            if (question == GroundQuestion::surface) {
                terrain_.surfacesBelow(centers, found_, loop);
            } else {
                terrain_.restingHeights(centers, radii, found_, loop);
            }
        }
        for (std::size_t i = 0; i < centers.size(); ++i) {
            heights_[i] = found_[i] ? found_[i]->height : kNone;
        }
    }

    [[nodiscard]] std::optional<OwnBytes> ownBytes() const override {
        return OwnBytes{grid_.memoryBytes() + terrain_.memoryBytes(), 0};
    }

private:
    Grid<float> grid_;
    Terrain<float> terrain_;
    Way way_;
    std::vector<Terrain<float>::Found> found_;
};

/// Something of Bullet's that is asked straight down, sphere by sphere: its fractionOf(from, to, radius) is how
/// much of the way it is until the ground is met; 1 where it is not.
template <class Ground>
class BulletGround final : public GroundRunner {
public:
    explicit BulletGround(const Spheres& spheres, const auto&... ofGround)
        : GroundRunner(spheres), ground_(ofGround...) {}

    void run() override {
        for (std::size_t i = 0; i < heights_.size(); ++i) {
            const btVector3 from = toBullet(spheres_.centers[i]);
            const btVector3 to(from.x(), kBelow, from.z());
            const btScalar fraction = ground_.fractionOf(from, to, spheres_.radii[i]);
            heights_[i] = fraction < 1 ? from.y() + fraction * (kBelow - from.y()) : kNone;
        }
    }

private:
    Ground ground_;
};

/// What a program does that has a Bullet world: casts a ray down, or lets the sphere fall.
class WorldGround {
public:
    explicit WorldGround(const HillMesh& mesh, GroundQuestion question)
        : mesh_(mesh), question_(question) {
        ground_.setCollisionShape(&mesh_.shape);
        world_.addCollisionObject(&ground_);
    }
    WorldGround(const WorldGround&) = delete;
    WorldGround& operator=(const WorldGround&) = delete;
    ~WorldGround() { world_.removeCollisionObject(&ground_); }

    btScalar fractionOf(const btVector3& from, const btVector3& to, float radius) {
        if (question_ == GroundQuestion::surface) {
            btCollisionWorld::ClosestRayResultCallback hit(from, to);
            world_.rayTest(from, to, hit);
            return hit.m_closestHitFraction;
        }
        const btSphereShape sphere(radius);
        btCollisionWorld::ClosestConvexResultCallback hit(from, to);
        world_.convexSweepTest(&sphere, btTransform(btQuaternion::getIdentity(), from),
                               btTransform(btQuaternion::getIdentity(), to), hit);
        return hit.m_closestHitFraction;
    }

private:
    MeshGround mesh_;
    GroundQuestion question_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btCollisionWorld world_{&dispatcher_, &broadphase_, &configuration_};
    btCollisionObject ground_;
};

std::vector<ContestantKind> groundKinds(GroundQuestion question) {
    std::vector<ContestantKind> kinds{
        {.name = "hash", .title = "Terrain, all at once", .ours = true},
        {.name = "hash-single", .title = "Terrain, one by one", .ours = true}};
    if (threadedLoop()) {
        kinds.push_back({.name = "hash-threads",
                         .title = "Terrain, all at once, tbbFor",
                         .ours = true,
                         .onThreads = true});
    }
    const auto add = [&](const char* name, std::string title) {
        kinds.push_back({.name = name,
                         .title = std::move(title),
                         .package = contestantKind(kBaseline).package});
    };
    const std::string worldsQuestion =
        question == GroundQuestion::rest ? "convexSweepTest" : "rayTest";
    add("dbvt", "btCollisionWorld::" + worldsQuestion + " down, on a btBvhTriangleMeshShape");
    if (question == GroundQuestion::surface) {
        add("mesh", "btBvhTriangleMeshShape::performRaycast");
        add("heightfield", "btHeightfieldTerrainShape::performRaycast, with its accelerator");
    }
    return kinds;
}

// --- The workload ----------------------------------------------------------------------------------

class TerrainWorkload final : public Workload {
public:
    TerrainWorkload(GroundQuestion question, std::size_t spheres, std::uint64_t seed)
        : spheres_{question, HillMesh(seed)}, random_(~seed) {
        for (std::size_t i = 0; i < spheres; ++i) {
            spheres_.centers.emplace_back(random_.between(-kRoom, kRoom), kAbove,
                                          random_.between(-kRoom, kRoom));
            spheres_.radii.push_back(question == GroundQuestion::rest ? random_.between(0.3F, 1)
                                                                      : 0);
            ways_.emplace_back(random_.between(-0.2F, 0.2F), 0, random_.between(-0.2F, 0.2F));
        }
    }

    [[nodiscard]] std::unique_ptr<Runner> make(const ContestantKind& kind) override {
        if (kind.name == kBaseline) {
            return std::make_unique<BulletGround<WorldGround>>(spheres_, spheres_.mesh,
                                                               spheres_.question);
        }
        if (kind.name == "mesh") {
            return std::make_unique<BulletGround<MeshGround>>(spheres_, spheres_.mesh);
        }
        if (kind.name == "heightfield") {
            return std::make_unique<BulletGround<HeightfieldGround>>(spheres_, spheres_.mesh);
        }
        return std::make_unique<OwnGround>(spheres_, kind.name == "hash-single" ? Way::oneByOne
                                                     : kind.onThreads           ? Way::threads
                                                                                : Way::batch);
    }

    void beginFrame() override {
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

    void listExactAnswers(std::vector<Answer>& answers) override {
        answers.clear();
        for (std::size_t i = 0; i < objects(); ++i) {
            answers.push_back(answerOf(i, 1));
        }
    }

    [[nodiscard]] std::size_t objects() const override { return spheres_.centers.size(); }

private:
    static constexpr float kRoom = HillMesh::kHalf - 2;

    Spheres spheres_;
    demos::Random random_;
    std::vector<Vector3<float>> ways_;  // a frame [m]
};

Benchmark groundBenchmark(const char* name, const char* description, GroundQuestion question) {
    return {.name = name,
            .group = "queries",
            .description = description,
            .operation = "sphere",
            .sizes = {50'000},
            .contestants = [question](std::size_t, std::uint64_t) { return groundKinds(question); },
            .make =
                [question](std::size_t objects, std::uint64_t seed) {
                    return std::make_unique<TerrainWorkload>(question, objects, seed);
                }};
}

}  // namespace

std::vector<Benchmark> terrainBenchmarks() {
    return {groundBenchmark("terrain", "the ground below each roaming sphere, 51,200 triangles",
                            GroundQuestion::surface),
            groundBenchmark("terrain-rest", "the height at which each sphere, of 0.3 to 1 m, rests",
                            GroundQuestion::rest),
            terrainEditBenchmark()};
}

}  // namespace hashphase::benchmarks
