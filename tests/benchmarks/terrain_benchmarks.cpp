// SPDX-License-Identifier: Zlib

// Who says how high the ground is: ours one by one, in a batch and on threads; Bullet's world, and its
// shapes by themselves.

#include <integration/bullet/conversions.hpp>
#include <integration/terrain/terrain.hpp>
#include <tests/benchmarks/peers/peers.hpp>
#include <tests/benchmarks/terrain_workload.hpp>

#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/NarrowPhaseCollision/btRaycastCallback.h>
#include <btBulletCollisionCommon.h>

#include <limits>
#include <optional>

namespace hashphase::benchmarks {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr float kBelow = -5;  // [m], where rays and sweeps end

enum class Way : std::uint8_t { oneByOne, batch, threads };

class Ours : public GroundContestant {
public:
    Ours(const HillMesh& mesh, Way way) : terrain_(grid_), way_(way) {
        terrain_.add(mesh.vertices(), mesh.indices());
        grid_.update();
    }

    void ask(GroundQuestion question, const Spheres& spheres, std::span<float> heights) override {
        found_.resize(heights.size());
        if (way_ == Way::oneByOne) {
            for (std::size_t i = 0; i < heights.size(); ++i) {
                found_[i] = question == GroundQuestion::surface
                                ? terrain_.surfaceBelow(spheres.centers[i])
                                : terrain_.restingHeight(spheres.centers[i], spheres.radii[i]);
            }
        } else {
            const ParallelFor loop =
                way_ == Way::threads ? *threadedLoop() : ParallelFor(serialFor);
            if (question == GroundQuestion::surface) {
                terrain_.surfacesBelow(spheres.centers, found_, loop);
            } else {
                terrain_.restingHeights(spheres.centers, spheres.radii, found_, loop);
            }
        }
        for (std::size_t i = 0; i < heights.size(); ++i) {
            heights[i] = found_[i] ? found_[i]->height : kNone;
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

/// Rays straight down through a shape.
class RaysAtShape : public GroundContestant {
public:
    void ask(GroundQuestion /*question*/, const Spheres& spheres,
             std::span<float> heights) override {
        for (std::size_t i = 0; i < heights.size(); ++i) {
            const btVector3 from = toBullet(spheres.centers[i]);
            Closest closest(from, btVector3(from.x(), kBelow, from.z()));
            cast(closest, from, btVector3(from.x(), kBelow, from.z()));
            heights[i] = closest.m_hitFraction < 1
                             ? from.y() + closest.m_hitFraction * (kBelow - from.y())
                             : kNone;
        }
    }

private:
    struct Closest : btTriangleRaycastCallback {
        using btTriangleRaycastCallback::btTriangleRaycastCallback;
        btScalar reportHit(const btVector3& /*normal*/, btScalar fraction, int /*part*/,
                           int /*index*/) override {
            return fraction;
        }
    };

    virtual void cast(btTriangleRaycastCallback& callback, const btVector3& from,
                      const btVector3& to) = 0;
};

class RaysAtHeightfield : public RaysAtShape {
public:
    explicit RaysAtHeightfield(const HillMesh& mesh) {
        for (const Vector3<float>& vertex : mesh.vertices()) {
            heights_.push_back(vertex[1]);
        }
        constexpr int side = HillMesh::kQuads + 1;
        // From -20 to 20, so that its middle is at 0.
        const float* heights = heights_.data();
        shape_.emplace(side, side, heights, btScalar(-20), btScalar(20), 1, false);
        shape_->setLocalScaling({HillMesh::kEdge, 1, HillMesh::kEdge});
        shape_->buildAccelerator();
    }

private:
    void cast(btTriangleRaycastCallback& callback, const btVector3& from,
              const btVector3& to) override {
        shape_->performRaycast(&callback, from, to);
    }

    std::vector<float> heights_;
    std::optional<btHeightfieldTerrainShape> shape_;
};

struct BulletMesh {
    explicit BulletMesh(const HillMesh& mesh)
        : vertices(mesh.vertices()),
          indices(mesh.indices().begin(), mesh.indices().end()),
          array(static_cast<int>(indices.size() / 3), indices.data(), 3 * sizeof(int),
                static_cast<int>(vertices.size()), vertices.data()->data(), sizeof(Vector3<float>)),
          shape(&array, true) {}

    std::vector<Vector3<float>> vertices;
    std::vector<int> indices;
    btTriangleIndexVertexArray array;
    btBvhTriangleMeshShape shape;
};

class RaysAtMesh : public RaysAtShape {
public:
    explicit RaysAtMesh(const HillMesh& mesh) : mesh_(mesh) {}

private:
    void cast(btTriangleRaycastCallback& callback, const btVector3& from,
              const btVector3& to) override {
        mesh_.shape.performRaycast(&callback, from, to);
    }

    BulletMesh mesh_;
};

/// What a program does that has a Bullet world: casts a ray down, or lets the sphere fall.
class World : public GroundContestant {
public:
    explicit World(const HillMesh& mesh) : mesh_(mesh) {
        ground_.setCollisionShape(&mesh_.shape);
        world_.addCollisionObject(&ground_);
    }
    ~World() override { world_.removeCollisionObject(&ground_); }

    void ask(GroundQuestion question, const Spheres& spheres, std::span<float> heights) override {
        for (std::size_t i = 0; i < heights.size(); ++i) {
            const btVector3 from = toBullet(spheres.centers[i]);
            const btVector3 to(from.x(), kBelow, from.z());
            const btScalar fraction = question == GroundQuestion::surface
                                          ? rayFraction(from, to)
                                          : fallFraction(from, to, spheres.radii[i]);
            heights[i] = fraction < 1 ? from.y() + fraction * (kBelow - from.y()) : kNone;
        }
    }

private:
    btScalar rayFraction(const btVector3& from, const btVector3& to) {
        btCollisionWorld::ClosestRayResultCallback hit(from, to);
        world_.rayTest(from, to, hit);
        return hit.m_closestHitFraction;
    }

    btScalar fallFraction(const btVector3& from, const btVector3& to, float radius) {
        const btSphereShape sphere(radius);
        btCollisionWorld::ClosestConvexResultCallback hit(from, to);
        world_.convexSweepTest(&sphere, btTransform(btQuaternion::getIdentity(), from),
                               btTransform(btQuaternion::getIdentity(), to), hit);
        return hit.m_closestHitFraction;
    }

    BulletMesh mesh_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btCollisionWorld world_{&dispatcher_, &broadphase_, &configuration_};
    btCollisionObject ground_;
};

Benchmark groundBenchmark(std::string name, std::string description, GroundQuestion question) {
    Benchmark benchmark;
    benchmark.name = std::move(name);
    benchmark.group = "queries";
    benchmark.description = std::move(description);
    benchmark.operation = "sphere";
    benchmark.sizes = {50'000};
    benchmark.contestants = [question](std::size_t /*objects*/, std::uint64_t /*seed*/) {
        return groundKinds(question);
    };
    benchmark.make = [question](std::size_t objects, std::uint64_t seed) {
        return std::make_unique<TerrainWorkload>(question, objects, seed);
    };
    return benchmark;
}

}  // namespace

std::vector<ContestantKind> groundKinds(GroundQuestion question) {
    std::vector<ContestantKind> kinds;
    const auto add = [&kinds](std::string name, std::string title, bool ours) {
        ContestantKind kind;
        kind.name = std::move(name);
        kind.title = std::move(title);
        kind.package = contestantKind(ours ? "hash" : kBaseline).package;
        kind.ours = ours;
        kinds.push_back(std::move(kind));
    };
    add("hash", "Terrain, all at once", true);
    add("hash-single", "Terrain, one by one", true);
    if (threadedLoop()) {
        add("hash-threads", "Terrain, all at once, tbbFor", true);
        kinds.back().onThreads = true;
    }
    if (question == GroundQuestion::surface) {
        add(std::string(kBaseline), "btCollisionWorld::rayTest down, on a btBvhTriangleMeshShape",
            false);
        add("mesh", "btBvhTriangleMeshShape::performRaycast", false);
        add("heightfield", "btHeightfieldTerrainShape::performRaycast, with its accelerator",
            false);
    } else {
        add(std::string(kBaseline),
            "btCollisionWorld::convexSweepTest down, on a btBvhTriangleMeshShape", false);
    }
    return kinds;
}

std::unique_ptr<GroundContestant> makeGroundContestant(std::string_view name,
                                                       const HillMesh& mesh) {
    if (name == "hash-single") {
        return std::make_unique<Ours>(mesh, Way::oneByOne);
    }
    if (name == "hash-threads") {
        return std::make_unique<Ours>(mesh, Way::threads);
    }
    if (name == kBaseline) {
        return std::make_unique<World>(mesh);
    }
    if (name == "mesh") {
        return std::make_unique<RaysAtMesh>(mesh);
    }
    if (name == "heightfield") {
        return std::make_unique<RaysAtHeightfield>(mesh);
    }
    return std::make_unique<Ours>(mesh, Way::batch);
}

std::vector<Benchmark> terrainBenchmarks() {
    std::vector<Benchmark> all;
    all.push_back(groundBenchmark(
        "terrain", "the ground below each of spheres that roam over 51,200 triangles",
        GroundQuestion::surface));
    all.push_back(groundBenchmark(
        "terrain-rest", "where each of these spheres, of 0.3 to 1 m, rests", GroundQuestion::rest));
    return all;
}

}  // namespace hashphase::benchmarks
