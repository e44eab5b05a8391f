// SPDX-License-Identifier: Zlib
//
// A world whose objects have all been removed, and whose broadphase and solver have been reset, moves
// as a new one does, to the last bit.

#include <tests/integration/bullet/boxes.hpp>
#include <tests/integration/bullet/dynamics.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <ostream>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

using Numbers = std::vector<btScalar>;

/// Levels of a game, one after the other in a world of Bullet's.
class Levels {
public:
    Levels(std::unique_ptr<btBroadphaseInterface> broadphase,
           std::unique_ptr<btOverlappingPairCache> cache)
        : scene_(std::move(broadphase), std::move(cache)) {}
    ~Levels() { unload(); }

    /// The same stack each time, with a ghost in it, a fast body, and some that are taken out again.
    Numbers play() {
        add(0, ground_, {0, -1, 0});
        for (int i = 0; i < 80; ++i) {
            add(1, box_,
                {btScalar(i % 5) * btScalar(1.02), btScalar(0.5) + btScalar(i / 20) * btScalar(1.2),
                 btScalar(i / 5 % 4) * btScalar(1.02) + btScalar(0.1) * btScalar(i / 20)});
        }
        const btGhostObject& ghost = scene_.addGhost(&large_, {2, 1, 2});
        add(1, ball_, {-30, 1, 2}).setLinearVelocity({90, 0, 0});
        Numbers numbers;
        for (int step = 0; step < 100; ++step) {
            scene_.step();
            if (step % 20 == 10) {
                remove(static_cast<std::size_t>(step / 2 + 5));
                add(1, ball_, {btScalar(2), 9, btScalar(step % 3)});
            }
            numbers.push_back(btScalar(ghost.getNumOverlappingObjects()));
        }
        for (const btRigidBody* body : bodies_) {
            const btVector3& place = body->getWorldTransform().getOrigin();
            numbers.insert(numbers.end(), {place[0], place[1], place[2]});
        }
        return numbers;
    }

    /// Something else, of other sizes, that ends in the middle: some of it removed in no order.
    void playSomethingElse(std::uint64_t seed) {
        BulletRandom random(seed);
        const auto any = [&] { return std::size_t(random.below(int(bodies_.size()))); };
        add(0, ground_, {0, -1, 0});
        for (int i = 0; i < 150; ++i) {
            add(1, i % 9 == 0 ? static_cast<btCollisionShape&>(large_) : ball_,
                random.vector(0, 8));
        }
        scene_.addGhost(&large_, {4, 1, 4});
        for (int step = 0; step < 30; ++step) {
            scene_.step();
            remove(any());
            add(1, ball_, {btScalar(step), 3, 0});
        }
        for (btRigidBody*& body : bodies_) {
            std::swap(body, bodies_[any()]);
        }
    }

    void reset(bool afterAStep) {
        unload();
        if (afterAStep) {
            scene_.step();  // a frame of the menu
        }
        scene_.solver().reset();
        scene_.broadphase().resetPool(&scene_.dispatcher());
    }

private:
    btRigidBody& add(btScalar mass, btCollisionShape& shape, const btVector3& at) {
        bodies_.push_back(&scene_.body(scene_.add(&shape, mass, placeAt(at))));
        return *bodies_.back();
    }
    void remove(std::size_t i) { scene_.world().removeRigidBody(bodies_[i]); }
    void unload() {
        for (int i = scene_.world().getNumCollisionObjects(); i-- > 0;) {
            btCollisionObject* const object = scene_.world().getCollisionObjectArray()[i];
            if (btRigidBody::upcast(object) == nullptr) {
                scene_.world().removeCollisionObject(object);
            }
        }
        for (btRigidBody* body : bodies_) {
            scene_.world().removeRigidBody(body);
        }
        bodies_.clear();
    }

    btBoxShape ground_{btVector3(50, 1, 50)};
    btBoxShape box_{btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5))};
    btBoxShape large_{btVector3(2, 2, 2)};
    btSphereShape ball_{btScalar(0.3)};
    DynamicsWorld scene_;
    std::vector<btRigidBody*> bodies_;
};

using MadeLevels = std::unique_ptr<Levels>;

template <int cacheKind, Sweep sweep = Sweep::none>
MadeLevels levelsOverHash() {
    auto cache = kCacheKinds[std::size_t(cacheKind)].make();
    auto broadphase = hashOver(cache.get(), {.sweep = sweep});
    return std::make_unique<Levels>(std::move(broadphase), std::move(cache));
}

struct LevelsOver {
    const char* name;
    MadeLevels (*make)();
};

void PrintTo(const LevelsOver& kind, std::ostream* out) {
    *out << kind.name;
}

class ResetWorld : public testing::TestWithParam<LevelsOver> {};

TEST_P(ResetWorld, MovesAsANewOneToTheLastBit) {
    const Numbers expected = GetParam().make()->play();
    for (const bool afterAStep : {false, true}) {
        SCOPED_TRACE(afterAStep);
        const MadeLevels levels = GetParam().make();
        ASSERT_EQ(levels->play(), expected) << "in two new worlds";
        levels->reset(afterAStep);
        ASSERT_EQ(levels->play(), expected) << "for the second time";
        levels->reset(afterAStep);
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
            levels->playSomethingElse(seed);
            levels->reset(afterAStep);
        }
        ASSERT_EQ(levels->play(), expected) << "after other levels";
    }
}

INSTANTIATE_TEST_SUITE_P(
    Broadphases, ResetWorld,
    testing::Values(LevelsOver{"btDbvtBroadphase",
                               [] {
                                   return std::make_unique<Levels>(
                                       makeBroadphase<btDbvtBroadphase>(), nullptr);
                               }},
                    LevelsOver{"default", levelsOverHash<0>},
                    LevelsOver{"canonical", levelsOverHash<2>},
                    LevelsOver{"sweeping", levelsOverHash<0, Sweep::automatic>},
                    LevelsOver{"btHashedOverlappingPairCache", levelsOverHash<3>}));

TEST(ResetPool, GivesBackMemory) {
    Boxes boxes;
    for (int i = 0; i < 5000; ++i) {
        boxes.create(boxAround({btScalar(i % 70), btScalar(i / 70), 0}, {1, 1, 1}));
    }
    boxes.step();
    boxes.broadphase.destroyProxies(boxes.proxies, nullptr);
    boxes.proxies.clear();
    const std::size_t before = boxes.broadphase.grid().memoryBytes();
    boxes.broadphase.resetPool(nullptr);
    EXPECT_LT(boxes.broadphase.grid().memoryBytes(), before / 2 + before / 4);
}

}  // namespace
}  // namespace hashphase::test
