// SPDX-License-Identifier: Zlib
//
// All clients at once on the grid of a live btDiscreteDynamicsWorld, which files its bodies once a
// frame for all of them: picking, culling, AI, terrain.

#include <tests/integration/bullet/bullet_scenes.hpp>
#include <tests/integration/bullet/dynamics.hpp>
#include <tests/support/camera_matrices.hpp>

#include <integration/ai/nearest.hpp>
#include <integration/ai/proximity.hpp>
#include <integration/ai/radar.hpp>
#include <integration/ai/rarest_colour.hpp>
#include <integration/ai/sight.hpp>
#include <integration/ai/zones.hpp>
#include <integration/bullet/conversions.hpp>
#include <integration/bullet/group_filter.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <integration/bullet/static_triangles.hpp>
#include <integration/camera/camera.hpp>
#include <integration/camera/frustum.hpp>
#include <integration/culling/culler.hpp>
#include <integration/picking/drag_selection.hpp>
#include <integration/picking/pick.hpp>
#include <integration/terrain/terrain.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <thread>
#include <vector>

namespace hashphase::test {
namespace {

using Scalar = btScalar;
using Ids = std::vector<ProxyId>;

constexpr int kRed = 64;             // a collision group, of every third body
constexpr double kGroundSide = 400;  // of the ground [m]
constexpr int kQuads = 40;           // of the ground, a side
constexpr Scalar kRadius = 10;       // within which agents have neighbours [m]

/// Spheres that roam over hills.
class RoamingBodies : public DynamicsWorld {
public:
    explicit RoamingBodies(int count) {
        addHills();
        BulletRandom random(0x5eed0801);
        auto* const sphere = keep(std::make_unique<btSphereShape>(btScalar(1)));
        for (int i = 0; i < count; ++i) {
            const btVector3 place(random.uniform(0, kGroundSide), random.uniform(6, 20),
                                  random.uniform(0, kGroundSide));
            bodies.push_back(add(sphere, 1, placeAt(place)));
            btRigidBody& roaming = body(bodies.back());
            roaming.setLinearVelocity(random.vector(-5, 5));
            if (i % 3 == 0) {
                roaming.getBroadphaseProxy()->m_collisionFilterGroup |= kRed;
            }
        }
        ground.update();
    }

    [[nodiscard]] int groupOf(ProxyId id) const {
        return hash().proxyOf(id)->m_collisionFilterGroup;
    }
    [[nodiscard]] bool isRed(ProxyId id) const { return (groupOf(id) & kRed) != 0; }
    [[nodiscard]] bool isHill(ProxyId id) const {
        return groupOf(id) == btBroadphaseProxy::StaticFilter;
    }

    std::vector<int> bodies;
    Grid<Scalar> ground;
    Terrain<Scalar> terrain{ground};

private:
    void addHills() {
        const auto vertex = [](int i, int k) {
            const double edge = kGroundSide / kQuads;
            const double height = 2 * std::sin(0.7 * i) + 2 * std::cos(0.5 * k);
            return btVector3(btScalar(edge * i), btScalar(height), btScalar(edge * k));
        };
        for (int i = 0; i < kQuads; ++i) {
            for (int k = 0; k < kQuads; ++k) {
                mesh_.addTriangle(vertex(i, k), vertex(i, k + 1), vertex(i + 1, k));
                mesh_.addTriangle(vertex(i + 1, k), vertex(i, k + 1), vertex(i + 1, k + 1));
            }
        }
        auto* const hills = keep(std::make_unique<btBvhTriangleMeshShape>(&mesh_, true));
        add(hills, 0, btTransform::getIdentity());
        std::vector<Vector3<Scalar>> corners;
        EXPECT_EQ(appendTriangles(*hills, btTransform::getIdentity(), corners), "");
        EXPECT_TRUE(terrain.add(corners).refused.empty());
    }

    btTriangleMesh mesh_;
};

/// Everything that a game asks in a frame.
class AllClients {
public:
    explicit AllClients(const RoamingBodies& world)
        : world_(world), red_(world.hash(), {.mask = kRed}) {
        Vector3<Scalar> middle(kGroundSide / 2, 5, kGroundSide / 2);
        static_cast<void>(zones.add({SphereRegion<Scalar>(middle, 30)}));
        static_cast<void>(zones.add({BoxRegion<Scalar>{{middle, Vector3<Scalar>(middle * 2)}}}));
        viewer.eye = middle;
        viewer.range = 40;
        viewer.halfAngle = Scalar(0.5);
        heights.resize(world.bodies.size());
        neighbourCounts.resize(world.bodies.size());
        colours.resize(world.bodies.size() + 1);
        std::iota(colours.begin(), colours.end(), 0U);
        for (std::uint32_t& colour : colours) {
            colour %= 8;
        }
    }

    void ask() {
        const Grid<Scalar>& grid = world_.grid();
        const Eigen::Vector3d eye(kGroundSide / 2, 25, kGroundSide / 2);
        const auto camera = cameraMatrix<Scalar>({}, eye, eye + Eigen::Vector3d(1, -0.3, 0.2));
        view = frustumRegion<Scalar>(camera, DepthRange::zeroToOne);
        culler.look(grid, view);

        const Camera<Scalar> window(camera, DepthRange::zeroToOne, {0, 0, 800, 500});
        ray = window.rayThrough({400, 250});
        picked = pickNearest(grid, ray, red_);
        pickAll(grid, ray, allPicked);
        selection = selectionRegion<Scalar>(window, {100, 100}, {300, 400});
        select(grid, window, {300, 400}, {100, 100}, selected);

        findWithin(grid, viewer.eye, kRadius, near, red_);
        estimateWithin(grid, viewer.eye, kRadius, estimate, red_);
        findNearest(grid, viewer.eye, 9, 1000, nearest, red_);
        const auto isHill = [&](ProxyId id) { return world_.isHill(id); };
        visibleFrom(grid, viewer, seen, red_, isHill);
        events = zones.update(grid);
        counts = radar.scan(grid, {.center = viewer.eye, .cellSize = 20, .columns = 8, .rows = 8},
                            2, [&](ProxyId id) { return world_.isRed(id) ? 1U : 0U; });
        const auto isBody = [&](ProxyId id) { return !isHill(id); };
        rarest.update(grid, kRadius, 8, colours, isBody);
        search.take(grid, kRadius, isBody);
        search.count(neighbourCounts);

        places.clear();
        for (const int body : world_.bodies) {
            places.push_back(positionOf(grid.box(world_.idOf(body))));
        }
        world_.terrain.surfacesBelow(places, heights);
    }

    // What was found.
    Culler<Scalar> culler;
    ConvexRegion<Scalar> view{{}};
    RayRegion<Scalar> ray{{0, 0, 0}, {0, 0, 0}};
    Picked<Scalar> picked;
    std::vector<Picked<Scalar>> allPicked;
    ConvexRegion<Scalar> selection{{}};
    Ids selected;
    Ids near;
    Ids estimate;
    std::vector<KeyedProxy<Scalar>> nearest;
    Viewer<Scalar> viewer;
    Ids seen;
    Zones<Scalar> zones;
    ZoneEvents events;
    Radar<Scalar> radar;
    std::span<const std::uint32_t> counts;
    RarestColour<Scalar> rarest;
    RadiusSearch<Scalar> search;
    std::vector<std::uint32_t> neighbourCounts;
    std::vector<std::uint32_t> colours;
    std::vector<Vector3<Scalar>> places;
    std::vector<Terrain<Scalar>::Found> heights;

private:
    const RoamingBodies& world_;
    GroupFilter red_;
};

/// Compares what was found with a look at every body.
class EveryBody {
public:
    EveryBody(const RoamingBodies& world, const AllClients& found) : world_(world), found_(found) {}

    void expectTheSame() {
        const auto isAny = [](ProxyId) { return true; };
        const auto isRed = [this](ProxyId id) { return world_.isRed(id); };
        const PositionRegion<Scalar> ball(found_.viewer.eye, kRadius);
        EXPECT_EQ(found_.near, idsIn(ball, isRed));
        EXPECT_TRUE(std::includes(found_.estimate.begin(), found_.estimate.end(),
                                  found_.near.begin(), found_.near.end()));
        EXPECT_EQ(found_.selected, idsIn(found_.selection, isAny));
        EXPECT_EQ(found_.allPicked.size(), idsIn(found_.ray, isAny).size());
        EXPECT_EQ(found_.picked.id.isNull(), idsIn(found_.ray, isRed).empty());
        const Ids visible = idsIn(found_.view, isAny);
        EXPECT_EQ(found_.culler.count(), visible.size());
        EXPECT_TRUE(std::all_of(visible.begin(), visible.end(),
                                [this](ProxyId id) { return found_.culler.isVisible(id); }));
        expectNearest();
        expectNeighbours();
        expectOnTheGround();
        EXPECT_EQ(found_.events.entered.size() + found_.events.stayed.size(),
                  found_.zones.occupants({0, 1}).size() + found_.zones.occupants({1, 1}).size());
        EXPECT_GT(std::accumulate(found_.counts.begin(), found_.counts.end(), 0U), 1000U);
        EXPECT_GT(found_.seen.size(), 10U);
        EXPECT_GT(visible.size(), 100U);
        EXPECT_GT(found_.selected.size(), 10U);
    }

private:
    template <class Region, class Accept>
    [[nodiscard]] Ids idsIn(const Region& region, const Accept& accept) const {
        Ids ids;
        world_.grid().forEach([&](ProxyId id, const Aabb<Scalar>& box) {
            if (region.key(box) >= 0 && accept(id)) {
                ids.push_back(id);
            }
        });
        return ids;
    }

    void expectNearest() const {
        std::vector<Scalar> distances;
        world_.grid().forEach([&](ProxyId id, const Aabb<Scalar>& box) {
            if (world_.isRed(id)) {
                distances.push_back((positionOf(box) - found_.viewer.eye).squaredNorm());
            }
        });
        std::sort(distances.begin(), distances.end());
        ASSERT_EQ(found_.nearest.size(), 9U);
        for (std::size_t i = 0; i < found_.nearest.size(); ++i) {
            EXPECT_FLOAT_EQ(static_cast<float>(found_.nearest[i].key),
                            static_cast<float>(distances[i]));
        }
    }

    // A few of all the agents.
    void expectNeighbours() const {
        const RadiusSearch<Scalar>& search = found_.search;
        ASSERT_EQ(search.size(), world_.bodies.size());
        EXPECT_EQ(found_.rarest.search().size(), search.size());
        for (std::uint32_t agent = 0; agent < search.size(); agent += 997) {
            const PositionRegion<Scalar> ball(search.position(agent), kRadius);
            const auto isOther = [&](ProxyId id) {
                return id != search.id(agent) && !world_.isHill(id);
            };
            EXPECT_EQ(found_.neighbourCounts[agent], idsIn(ball, isOther).size());
        }
    }

    void expectOnTheGround() const {
        for (std::size_t i = 0; i < found_.places.size(); i += 997) {
            const Vector3<Scalar>& place = found_.places[i];
            const btVector3 from = toBullet(place);
            const btVector3 to = from - btVector3(0, 100, 0);
            struct HillsOnly : btCollisionWorld::ClosestRayResultCallback {
                using ClosestRayResultCallback::ClosestRayResultCallback;
                bool needsCollision(btBroadphaseProxy* proxy) const override {
                    return proxy->m_collisionFilterGroup == btBroadphaseProxy::StaticFilter;
                }
            } hit(from, to);
            world_.hash().closestRay(from, to, hit);
            ASSERT_EQ(found_.heights[i].has_value(), hit.hasHit());
            if (hit.hasHit()) {
                EXPECT_NEAR(double(found_.heights[i]->height), double(hit.m_hitPointWorld.y()),
                            1e-3);
            }
        }
    }

    const RoamingBodies& world_;
    const AllClients& found_;
};

TEST(AllClientsTest, AskAboutThirtyThousandBodiesInAFrameThatFilesThemOnce) {
    RoamingBodies world(30000);
    AllClients clients(world);
    world.step();
    for (int frame = 0; frame < 3; ++frame) {
        const std::uint64_t filings = world.grid().filingCount();
        world.step();
        EXPECT_EQ(world.grid().filingCount(), filings + 1);
        clients.ask();
        EXPECT_EQ(world.grid().filingCount(), filings + 1);
        EXPECT_GT(world.hash().lastCost().grid.changed, 29000U);
        EveryBody(world, clients).expectTheSame();
        ASSERT_FALSE(HasFailure()) << "frame " << frame;
    }
    EXPECT_EQ(world.ground.filingCount(), 1U);
    EXPECT_EQ(world.hash().validate(), "");
}

TEST(AllClientsTest, SeeABodyThatIsMovedByHandAtOnce) {
    RoamingBodies world(500);
    AllClients clients(world);
    world.step();
    clients.ask();
    const ProxyId id = world.idOf(world.bodies[0]);  // a red one
    btRigidBody& body = world.body(world.bodies[0]);
    putAt(body, toBullet(clients.viewer.eye));
    world.world().updateSingleAabb(&body);
    clients.ask();
    EXPECT_EQ(clients.nearest.front().id, id);
    EXPECT_TRUE(std::binary_search(clients.near.begin(), clients.near.end(), id));
    const auto occupants = clients.zones.occupants({0, 1});
    EXPECT_TRUE(std::binary_search(occupants.begin(), occupants.end(), id));
    EXPECT_TRUE(std::any_of(clients.events.entered.begin(), clients.events.entered.end(),
                            [id](const ZoneEvent& event) { return event.proxy == id; }));
}

// What goes wrong here is mostly for the thread sanitizer to see.
TEST(AllClientsTest, AskOnSeveralThreadsAtOnceRightAfterManyMoves) {
    RoamingBodies world(2000);
    constexpr int kThreads = 4;
    std::vector<std::unique_ptr<AllClients>> clients;
    for (int i = 0; i < kThreads; ++i) {
        clients.push_back(std::make_unique<AllClients>(world));
    }
    for (int frame = 0; frame < 6; ++frame) {
        world.step();
        world.world().updateAabbs();  // of all that has moved in the step: waits to be filed
        std::vector<std::thread> threads;
        for (const auto& own : clients) {
            threads.emplace_back([&own] { own->ask(); });
        }
        for (std::thread& thread : threads) {
            thread.join();
        }
        for (const auto& own : clients) {
            EXPECT_EQ(own->near, clients[0]->near);
            EXPECT_EQ(own->selected, clients[0]->selected);
            EXPECT_EQ(own->colours, clients[0]->colours);
            EXPECT_EQ(own->heights, clients[0]->heights);
            EXPECT_EQ(own->culler.count(), clients[0]->culler.count());
        }
    }
}

}  // namespace
}  // namespace hashphase::test
