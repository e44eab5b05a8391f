// SPDX-License-Identifier: Zlib
//
// Coordinates that are no numbers, or too large for a cell.

#include <demos/stability/cases/cases.hpp>

#include <broadphase/diagnostics.hpp>
#include <broadphase/pairs.hpp>
#include <demos/compare/trial.hpp>
#include <demos/console/format.hpp>
#include <demos/stability/pair_scene.hpp>
#include <integration/bullet/conversions.hpp>

#include <btBulletDynamicsCommon.h>

#include <array>
#include <cmath>
#include <limits>

namespace hashphase::demos {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// Some that touch each other, for the strange ones to stand among.
Boxes ordinaryBoxes(const CaseContext& context) {
    return scatteredCubes(60, 8, 0.5F, 1.5F, context.seed);
}

CaseOutcome hugeCoordinates(const CaseContext& context) {
    Boxes boxes = ordinaryBoxes(context);
    for (const float far : {3e9F, -3e9F, 1e18F, -1e18F, kInfinity, -kInfinity, kNan}) {
        for (int axis = 0; axis < 3; ++axis) {
            Vector3<float> low = Vector3<float>::Zero();
            low[axis] = far;
            boxes.emplace_back(low, low + Vector3<float>::Ones());  // beyond on one axis
            boxes.emplace_back(Vector3<float>::Constant(-1).cwiseMin(low),
                               Vector3<float>::Ones().cwiseMax(low));  // from here to there
        }
        boxes.push_back(cubeAt(Vector3<float>::Constant(far), 1));
    }
    CaseTally tally;
    judgePairs(context, tally, boxes, {.cellSize = 1});
    judgePairs(context, tally, boxes);
    return tally.outcome();
}

// --- Planes without end ---------------------------------------------------------------------------

// Boxes in motion, with or without a plane that all of them touch.
class PlaneWorld {
public:
    PlaneWorld(const CaseContext& context, std::size_t count, bool hasPlane)
        : hasPlane_(hasPlane),
          boxes_(scatteredCubes(count, 60, 0.5F, 1.5F, context.seed)),
          scene_(context, withPlane(), {}, worldOf(boxes_)) {}

    void frame() {
        shift_ = shift_ > 0 ? -0.25F : 0.25F;
        for (Aabb<float>& box : boxes_) {
            box.translate(Vector3<float>(shift_, 0, 0));
        }
        scene_.moveAll(withPlane());
        scene_.findPairs();
    }

    PairScene& scene() noexcept { return scene_; }

private:
    [[nodiscard]] Boxes withPlane() const {
        Boxes all = boxes_;
        if (hasPlane_) {
            all.emplace_back(Vector3<float>::Constant(-1e18F), Vector3<float>::Constant(1e18F));
        }
        return all;
    }

    bool hasPlane_;
    float shift_ = 0;
    Boxes boxes_;
    PairScene scene_;
};

// The plane of double precision, in the grid alone.
void judgeDoublePlane(CaseTally& tally) {
    Grid<double> grid;
    Pairs<double> pairs(grid);
    constexpr std::size_t kCount = 100;
    for (std::size_t i = 0; i < kCount; ++i) {
        const Vector3<double> low(3.0 * static_cast<double>(i), 0, 0);
        static_cast<void>(grid.add({low, low + Vector3<double>::Ones()}));
    }
    const auto end = Vector3<double>::Constant(1e30);
    static_cast<void>(grid.add({-end, end}));
    pairs.update([](ProxyId, ProxyId) { return true; });
    tally.expect(pairs.count() == kCount, "a plane of 1e30 m pairs once with everyone");
}

CaseOutcome endlessPlane(const CaseContext& context) {
    const std::size_t count = context.quickOrFull<std::size_t>(500, 2000);
    PlaneWorld with(context, count, true);
    PlaneWorld without(context, count, false);
    CaseTally tally;
    with.scene().judge(tally);
    without.scene().judge(tally);
    for (int i = 0; i < 4; ++i) {
        with.frame();
        without.frame();
    }
    with.scene().judge(tally);
    const auto time = [](PlaneWorld& world) { return shortestTime(5, [&] { world.frame(); }); };
    const double ratio = time(with) / time(without);
    if (const SpatialHashBroadphase* hash = with.scene().hash()) {
        judgeDoublePlane(tally);
        // That a box still touches the plane is one test; that is all that the plane may add.
        const auto work = [](const SpatialHashBroadphase& of) {
            return static_cast<double>(of.lastCost().boxesTested);
        };
        const double added = work(*hash) - work(*without.scene().hash());
        tally.addCost(
            1 + std::max(0.0, added - static_cast<double>(count)) / work(*without.scene().hash()),
            1.05);
        tally.note(
            "Cost: boxes tested in a frame, less one for each pair with the plane. With the "
            "plane, a frame takes " +
            fixed(ratio, 1) + " times as long.");
    } else {
        tally.addCost(ratio, 3);
        tally.note("Cost: the time of a frame with the plane, by that without.");
    }
    return tally.outcome();
}

// --- NaN ------------------------------------------------------------------------------------------

int messages = 0;

void countMessage(const char* /*message*/) {
    ++messages;
}

// Handed over field by field: Eigen's boxes are built from corners.
Aabb<float> withNan(Aabb<float> box, int field) {
    (field < 3 ? box.min() : box.max())[field % 3] = kNan;
    return box;
}

CaseOutcome nanInOneField(const CaseContext& context) {
    CaseTally tally;
    for (int field = 0; field < 6; ++field) {
        messages = 0;
        const MessageHandler before = setMessageHandler(&countMessage);
        Boxes boxes = ordinaryBoxes(context);
        boxes[7] = withNan(boxes[7], field);
        PairScene scene(context, boxes);
        scene.judge(tally);
        // The others live on, and one more becomes NaN and good again.
        for (int frame = 0; frame < 6; ++frame) {
            for (std::uint32_t i = 20; i < 40; ++i) {
                scene.move(
                    i, boxes[i].translated(Vector3<float>(0.2F * static_cast<float>(frame), 0, 0)));
            }
            scene.move(3, frame == 2 ? withNan(boxes[3], field) : boxes[3]);
            scene.judge(tally);
        }
        setMessageHandler(before);
        if (const SpatialHashBroadphase* hash = scene.hash()) {
            tally.expect(hash->grid().nanCount() == 1, "NaN boxes are counted");
            tally.expect(messages == 1, "NaN is reported once");
            tally.expect(hash->validate().empty(), "all invariants hold");
        }
    }
    return tally.outcome();
}

// --- A body that is too large for Bullet ----------------------------------------------------------

struct SmallWorld {
    explicit SmallWorld(const CaseContext& context)
        : broadphase(context.kind.make(
              {Aabb<float>(Vector3<float>::Constant(-1000), Vector3<float>::Constant(1000)), 16})),
          world(&dispatcher, broadphase.get(), &solver, &configuration) {
        world.setGravity({0, 0, 0});
    }

    ~SmallWorld() {
        for (const std::unique_ptr<btRigidBody>& body : bodies) {
            world.removeRigidBody(body.get());
        }
    }
    SmallWorld(const SmallWorld&) = delete;
    SmallWorld& operator=(const SmallWorld&) = delete;

    btRigidBody& add(float mass, float halfExtent, const btVector3& at) {
        shapes.push_back(
            std::make_unique<btBoxShape>(btVector3(halfExtent, halfExtent, halfExtent)));
        btVector3 inertia(0, 0, 0);
        if (mass > 0) {
            shapes.back()->calculateLocalInertia(mass, inertia);
        }
        btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shapes.back().get(), inertia);
        info.m_startWorldTransform.setOrigin(at);
        bodies.push_back(std::make_unique<btRigidBody>(info));
        world.addRigidBody(bodies.back().get());
        return *bodies.back();
    }

    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btSequentialImpulseConstraintSolver solver;
    std::unique_ptr<btBroadphaseInterface> broadphase;
    btDiscreteDynamicsWorld world;
    std::vector<std::unique_ptr<btBoxShape>> shapes;
    std::vector<std::unique_ptr<btRigidBody>> bodies;
};

// The pairs in the cache against those of the boxes that the proxies have.
void judgeWorld(const SmallWorld& world, CaseTally& tally) {
    Boxes boxes;
    std::vector<CollisionFilter> filters;
    for (const std::unique_ptr<btRigidBody>& body : world.bodies) {
        const btBroadphaseProxy& proxy = *body->getBroadphaseHandle();
        btVector3 low, high;
        world.broadphase->getAabb(body->getBroadphaseHandle(), low, high);
        boxes.push_back(toAabb(low, high));
        filters.push_back({proxy.m_collisionFilterGroup, proxy.m_collisionFilterMask});
    }
    const auto numberOf = [&](const btBroadphaseProxy& proxy) {
        std::uint32_t number = 0;
        while (world.bodies[number].get() != proxy.m_clientObject) {
            ++number;
        }
        return number;
    };
    std::vector<PairKey> reported;
    std::vector<PairKey> exact;
    listPairs(*world.broadphase->getOverlappingPairCache(), numberOf, reported);
    findExactPairs(ReferenceMethod::kBrute, boxes, filters, exact);
    tally.compare(reported, exact);
}

CaseOutcome bodyBeyondBullet(const CaseContext& context) {
    SmallWorld world(context);
    for (int i = 0; i < 5; ++i) {
        world.add(1, 0.6F, {static_cast<float>(i), 0, 0});
    }
    const btRigidBody& still = world.add(0, 6e5F, {0, -6.1e5F, 0});
    const btRigidBody& giant = world.add(1, 6e5F, {0, 6.1e5F, 0});
    CaseTally tally;
    for (int step = 0; step < 3; ++step) {
        world.world.stepSimulation(1 / 60.0F, 0);
        world.world.performDiscreteCollisionDetection();
        judgeWorld(world, tally);
    }
    tally.expect(giant.getActivationState() == DISABLE_SIMULATION,
                 "Bullet disables the large body");
    tally.expect(still.getActivationState() != DISABLE_SIMULATION, "a static one stays");
    return tally.outcome();
}

// --- Boxes inside out -----------------------------------------------------------------------------

CaseOutcome invertedBoxes(const CaseContext& context) {
    Boxes boxes = ordinaryBoxes(context);
    constexpr float kMost = std::numeric_limits<float>::max();
    for (int axes = 1; axes < 8; ++axes) {
        Vector3<float> low(-1, -1, -1);
        Vector3<float> high(1, 1, 1);
        for (int axis = 0; axis < 3; ++axis) {
            if ((axes >> axis & 1) != 0) {
                std::swap(low[axis], high[axis]);
            }
        }
        boxes.emplace_back(low, high);
        boxes.emplace_back(50 * low, 50 * high);
    }
    boxes.emplace_back(Vector3<float>::Constant(kMost), Vector3<float>::Constant(-kMost));
    boxes.emplace_back(Vector3<float>::Constant(kInfinity), Vector3<float>::Constant(-kInfinity));
    CaseTally tally;
    PairScene scene(context, boxes, {}, worldOf(ordinaryBoxes(context)));
    scene.judge(tally);
    for (std::uint32_t i = 0; i < 30; ++i) {
        scene.move(i, boxes[i].translated(Vector3<float>(0.3F, 0, 0)));
    }
    scene.judge(tally);
    return tally.outcome();
}

// --- Cell numbers ---------------------------------------------------------------------------------

CaseOutcome cellNumbersThatOverflow(const CaseContext& context) {
    CaseTally tally;
    for (const float far : {0x1p31F, 0x1p32F, 0x1p62F, 0x1p64F}) {
        Boxes boxes = ordinaryBoxes(context);
        const float ulp = far * 0x1p-23F;
        for (int corner = 0; corner < 8; ++corner) {
            const Vector3<float> at((corner & 1) != 0 ? far : -far, (corner & 2) != 0 ? far : -far,
                                    (corner & 4) != 0 ? far : -far);
            for (const float aside : {-ulp, 0.0F, ulp, 2 * ulp}) {
                const Vector3<float> low = at + Vector3<float>::Constant(aside);
                boxes.emplace_back(low, low + Vector3<float>::Constant(ulp));
            }
        }
        judgePairs(context, tally, boxes, {.cellSize = 1});
    }
    return tally.outcome();
}

constexpr std::array kNumberCases{
    HardCase{"H1", "coordinates beyond any cell",
             "60 boxes around the origin, cells of 1 m, and boxes at or reaching to 3e9, 1e18, "
             "infinity (each sign) and NaN, on one axis and on all; automatic cells too",
             "pairs as comparing the coordinates says; no conversion overflows", hugeCoordinates},
    HardCase{"H2", "a plane of 1e18 m",
             "btStaticPlaneShape's box, +-1e18 m on all axes (+-1e30 in double precision), below "
             "boxes that all move",
             "the plane pairs once with everyone, and costs no more than its pairs", endlessPlane},
    HardCase{"H3", "NaN in one field of a box",
             "60 boxes, of which one has NaN in one of its six fields; others move for six frames, "
             "and another one is NaN in one of them",
             "NaN pairs with nothing, is reported once and counted; all other pairs are exact",
             nanInOneField},
    HardCase{
        "H4", "a dynamic body of 1.2e6 m",
        "a world with five small bodies, a static one and a dynamic one of 1.2e6 m, three steps",
        "Bullet disables the dynamic one as under any broadphase, keeps the static one; pairs "
        "exact",
        bodyBeyondBullet},
    HardCase{"H5", "boxes inside out",
             "60 boxes, and boxes with min > max on one, two and three axes, small and large, and "
             "the empty box of +-FLT_MAX and +-infinity",
             "pairs as comparing the coordinates says, as Bullet's own overlap test does",
             invertedBoxes},
    HardCase{"H30", "cell numbers beyond 2^31",
             "cells of 1 m, boxes of 1 to 2 ulp at the eight corners +-2^31, 2^32, 2^62, 2^64",
             "exact pairs; no product overflows", cellNumbersThatOverflow},
};

}  // namespace

std::span<const HardCase> numberCases() {
    return kNumberCases;
}

}  // namespace hashphase::demos
