// SPDX-License-Identifier: Zlib
//
// All clients at once on the grid of a live btDiscreteDynamicsWorld, which files its bodies once a
// frame for all of them: picking, culling, AI, terrain. They find what a look at every body finds, and
// what they find in a grid of their own with the same boxes.

#include <demos/stability/run_together.hpp>
#include <integration/bullet/conversions.hpp>
#include <integration/bullet/group_filter.hpp>
#include <integration/bullet/static_triangles.hpp>
#include <integration/terrain/terrain.hpp>
#include <tests/integration/all_clients.hpp>
#include <tests/integration/bullet/dynamics.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <numeric>
#include <vector>

namespace hashphase::test {
namespace {

using Scalar = btScalar;

constexpr int kRed = 64;             // a collision group, of every third body
constexpr double kGroundSide = 400;  // of the ground [m]
constexpr int kQuads = 40;           // of the ground, a side
const Vector3<Scalar> kMiddle(kGroundSide / 2, 5, kGroundSide / 2);

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

    /// What it asks is about red bodies, or of hills; it has a colour for some more bodies than there are.
    [[nodiscard]] AllClients<Scalar> clients() const {
        const auto isHill = [this](ProxyId id) {
            return hash().proxyOf(id)->m_collisionFilterGroup == btBroadphaseProxy::StaticFilter;
        };
        return {{kMiddle}, bodies.size() + 9, GroupFilter(hash(), {.mask = kRed}), isHill};
    }
    /// The ground below each body.
    [[nodiscard]] std::vector<Terrain<Scalar>::Found> heights() const {
        std::vector<Vector3<Scalar>> places;
        for (const int body : bodies) {
            places.push_back(positionOf(grid().box(idOf(body))));
        }
        std::vector<Terrain<Scalar>::Found> found(places.size());
        terrain.surfacesBelow(places, found);
        return found;
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

/// Looks at every body of a world, or of each 997th one where that takes long.
class EveryBody {
public:
    explicit EveryBody(const RoamingBodies& world) : world_(world) {}

    void expectTheSame(const AllClients<Scalar>& found) const {
        const Vector3<Scalar> eye = found.viewers[0].eye;
        const PositionRegion<Scalar> ball(eye, found.kRadius);
        EXPECT_EQ(found.within, idsIn(ball, found.accepts));
        EXPECT_TRUE(std::ranges::includes(found.estimated, found.within));

        const Camera<Scalar> camera = found.camera();
        EXPECT_EQ(found.selected,
                  idsIn(selectionRegion<Scalar>(camera, found.kDragFrom, found.kDragTo)));
        std::vector<std::uint32_t> visible;
        for (const ProxyId id :
             idsIn(frustumRegion<Scalar>(camera.viewProjection(), camera.depthRange()))) {
            visible.push_back(id.index);
        }
        EXPECT_EQ(found.visible, visible);
        EXPECT_GT(visible.size(), 100U);

        // First all that the ray hits, at last the nearest one that is wanted.
        const RayRegion<Scalar> ray = camera.rayThrough(found.kPointer);
        auto hit = idsIn(ray);
        ASSERT_GE(found.picked.size(), hit.size());
        std::vector<ProxyId> picked(found.picked.begin(), found.picked.begin() + std::ssize(hit));
        std::ranges::sort(picked);
        EXPECT_EQ(picked, hit);
        EXPECT_EQ(found.picked.back().isNull(), idsIn(ray, found.accepts).empty());
        expectNearest(found);
        expectNeighbours(found);
    }

    /// The height of the ground below each body is where a ray meets it.
    void expectTheGround(const std::vector<Terrain<Scalar>::Found>& heights) const {
        for (std::size_t i = 0; i < heights.size(); i += 997) {
            const ProxyId id = world_.idOf(world_.bodies[i]);
            const btVector3 from = toBullet(positionOf(world_.grid().box(id)));
            const btVector3 to = from - btVector3(0, 100, 0);
            struct HillsOnly : btCollisionWorld::ClosestRayResultCallback {
                using ClosestRayResultCallback::ClosestRayResultCallback;
                bool needsCollision(btBroadphaseProxy* proxy) const override {
                    return proxy->m_collisionFilterGroup == btBroadphaseProxy::StaticFilter;
                }
            } hit(from, to);
            world_.hash().closestRay(from, to, hit);
            ASSERT_EQ(heights[i].has_value(), hit.hasHit());
            if (hit.hasHit()) {
                EXPECT_NEAR(heights[i]->height, hit.m_hitPointWorld.y(), 1e-3);
            }
        }
    }

private:
    template <class Region, class Accept = decltype([](ProxyId) { return true; })>
    [[nodiscard]] std::vector<ProxyId> idsIn(const Region& region,
                                             const Accept& accept = {}) const {
        std::vector<ProxyId> ids;
        world_.grid().forEach([&](ProxyId id, const Aabb<Scalar>& box) {
            if (region.key(box) >= 0 && accept(id)) {
                ids.push_back(id);
            }
        });
        return ids;
    }

    void expectNearest(const AllClients<Scalar>& found) const {
        std::vector<Scalar> distances;
        world_.grid().forEach([&](ProxyId id, const Aabb<Scalar>& box) {
            if (found.accepts(id)) {
                distances.push_back((positionOf(box) - found.viewers[0].eye).squaredNorm());
            }
        });
        std::ranges::sort(distances);
        ASSERT_EQ(found.nearest.size(), found.kNearest);
        for (std::size_t i = 0; i < found.kNearest; ++i) {
            EXPECT_FLOAT_EQ(static_cast<float>(found.nearest[i].key),
                            static_cast<float>(distances[i]));
        }
    }

    void expectNeighbours(const AllClients<Scalar>& found) const {
        const RadiusSearch<Scalar>& agents = found.agents();
        ASSERT_EQ(agents.size(), world_.bodies.size());
        for (std::uint32_t agent = 0; agent < agents.size(); agent += 997) {
            const PositionRegion<Scalar> ball(agents.position(agent), found.kRadius);
            const auto isOther = [&](ProxyId id) {
                return id != agents.id(agent) && !found.blocks(id);
            };
            EXPECT_EQ(found.neighbourCounts[agent], idsIn(ball, isOther).size());
        }
    }

    const RoamingBodies& world_;
};

TEST(AllClientsTest, AskAboutThirtyThousandBodiesInAFrameThatFilesThemOnce) {
    RoamingBodies world(30000);
    AllClients<Scalar> clients = world.clients();
    AllClients<Scalar> others = world.clients();
    world.step();
    // The size of its cells, by which estimates go, follows from the same boxes.
    Grid<Scalar> twin;
    for (int i = 0; i < world.bodyCount(); ++i) {
        ASSERT_EQ(twin.add(world.grid().box(world.idOf(i))), world.idOf(i));
    }
    twin.update();
    for (int frame = 0; frame < 3; ++frame) {
        const std::uint64_t filings = world.grid().filingCount();
        world.step();
        EXPECT_EQ(world.grid().filingCount(), filings + 1);
        clients.ask(world.grid());
        EXPECT_EQ(world.grid().filingCount(), filings + 1);
        EXPECT_GT(world.hash().lastCost().grid.changed, 29000U);
        for (int i = 0; i < world.bodyCount(); ++i) {
            twin.move(world.idOf(i), world.grid().box(world.idOf(i)));
        }
        twin.update();
        others.ask(twin);
        ASSERT_EQ(world.grid().cellSize(), twin.cellSize());
        EXPECT_TRUE(clients.answers() == others.answers());
        EXPECT_EQ(clients.entered, others.entered);
        EXPECT_EQ(clients.left, others.left);
        EveryBody(world).expectTheSame(clients);
        EXPECT_GT(std::accumulate(clients.counts.begin(), clients.counts.end(), 0U), 1000U);
        EXPECT_GT(clients.seen.size(), 10U);
        EXPECT_GT(clients.selected.size(), 10U);
        const auto heights = world.heights();
        EveryBody(world).expectTheGround(heights);
        EXPECT_GT(std::ranges::count_if(heights, [](auto& height) { return !!height; }), 29000);
        ASSERT_FALSE(HasFailure()) << "frame " << frame;
    }
    EXPECT_EQ(world.ground.filingCount(), 1U);
    EXPECT_EQ(world.hash().validate(), "");
}

TEST(AllClientsTest, SeeABodyThatIsMovedByHandAtOnceAndThatComesBackAsSomebodyElse) {
    RoamingBodies world(500);
    AllClients<Scalar> clients = world.clients();
    world.step();
    clients.ask(world.grid());
    const int number = world.bodies[0];  // a red one
    const ProxyId id = world.idOf(number);
    putAt(world.body(number), toBullet(kMiddle));
    world.world().updateSingleAabb(&world.body(number));
    clients.ask(world.grid());
    EXPECT_EQ(clients.nearest.front().id, id);
    EXPECT_TRUE(std::ranges::binary_search(clients.within, id));
    EXPECT_TRUE(std::ranges::binary_search(clients.zones.occupants({0, 1}), id));
    EXPECT_GE(std::ranges::count(clients.entered, id, &ZoneEvent::proxy), 1);

    // Who is taken out of the world leaves under the old id.
    world.readd(number, placeAt(toBullet(kMiddle)));
    ASSERT_NE(world.idOf(number), id);
    clients.ask(world.grid());
    EXPECT_EQ(clients.left.at(0).proxy, id);
    EXPECT_EQ(clients.entered.at(0).proxy, world.idOf(number));
}

// What goes wrong here is mostly for the thread sanitizer to see.
TEST(AllClientsTest, AskOnSeveralThreadsAtOnceRightAfterManyMoves) {
    RoamingBodies world(2000);
    struct Own {
        explicit Own(const RoamingBodies& owner) : clients(owner.clients()) {}
        AllClients<Scalar> clients;
        std::vector<Terrain<Scalar>::Found> heights;
    };
    std::deque<Own> all;
    for (int i = 0; i < 4; ++i) {
        all.emplace_back(world);
    }
    for (int frame = 0; frame < 6; ++frame) {
        world.step();
        world.world().updateAabbs();  // of all that has moved in the step: waits to be filed
        demos::runTogether(all.size(), [&](std::size_t thread) {
            all[thread].clients.ask(world.grid());
            all[thread].heights = world.heights();
        });
        for (const Own& own : all) {
            EXPECT_TRUE(own.clients.answers() == all[0].clients.answers());
            EXPECT_EQ(own.heights, all[0].heights);
        }
    }
}

}  // namespace
}  // namespace hashphase::test
