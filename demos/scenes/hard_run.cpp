// SPDX-License-Identifier: Zlib
#include <demos/scenes/hard_run.hpp>

#include <algorithm>
#include <array>

namespace hashphase::demos {
namespace {

constexpr btScalar kStep = btScalar(1) / btScalar(60);
constexpr int kStepsPerLook = 10;  // of the penetration meter

double kineticEnergy(const btRigidBody& body) {
    const btVector3& speed = body.getLinearVelocity();
    const btVector3 spin = body.getWorldTransform().getBasis().transpose() *
                           body.getAngularVelocity();  // about the body's own axes
    double twice = double{speed.length2()} * double{body.getMass()};
    for (int axis = 0; axis < 3; ++axis) {
        const double inverseInertia = body.getInvInertiaDiagLocal()[axis];
        twice += inverseInertia > 0 ? double{spin[axis]} * double{spin[axis]} / inverseInertia : 0;
    }
    return twice / 2;
}

bool canPush(btRigidBody& a, btRigidBody& b) {
    return !(a.isStaticObject() && b.isStaticObject()) && a.hasContactResponse() &&
           b.hasContactResponse() && a.checkCollideWith(&b) && b.checkCollideWith(&a);
}

}  // namespace

double PenetrationMeter::deepest(const WorldContents& contents) {
    const auto bodies = contents.bodies();
    std::vector<std::array<btVector3, 2>> boxes(bodies.size());
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        bodies[i]->getAabb(boxes[i][0], boxes[i][1]);
    }
    const auto doOverlap = [&boxes](std::size_t i, std::size_t j) {
        return TestAabbAgainstAabb2(boxes[i][0], boxes[i][1], boxes[j][0], boxes[j][1]);
    };
    double most = 0;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        for (std::size_t j = i + 1; j < bodies.size(); ++j) {
            if (doOverlap(i, j) && canPush(*bodies[i], *bodies[j])) {
                most = std::max(most, depthOf(*bodies[i], *bodies[j]));
            }
        }
    }
    return most;
}

double PenetrationMeter::depthOf(const btCollisionObject& a, const btCollisionObject& b) {
    const btCollisionObjectWrapper wrapA(nullptr, a.getCollisionShape(), &a, a.getWorldTransform(),
                                         -1, -1);
    const btCollisionObjectWrapper wrapB(nullptr, b.getCollisionShape(), &b, b.getWorldTransform(),
                                         -1, -1);
    btCollisionAlgorithm* const algorithm =
        dispatcher_.findAlgorithm(&wrapA, &wrapB, nullptr, BT_CONTACT_POINT_ALGORITHMS);
    btManifoldResult result(&wrapA, &wrapB);
    algorithm->processCollision(&wrapA, &wrapB, btDispatcherInfo(), &result);
    btManifoldArray manifolds;
    algorithm->getAllContactManifolds(manifolds);
    double most = 0;
    for (int i = 0; i < manifolds.size(); ++i) {
        for (int point = 0; point < manifolds[i]->getNumContacts(); ++point) {
            most = std::max(most, -double{manifolds[i]->getContactPoint(point).getDistance()});
        }
    }
    algorithm->~btCollisionAlgorithm();
    dispatcher_.freeCollisionAlgorithm(algorithm);
    return most;
}

HardRun::HardRun(const HardWorld& world, const PhysicsBroadphase& broadphase, ListOrder order)
    : hard_(world), world_(broadphase, order) {
    const auto offset = static_cast<btScalar>(world.offset);
    world.fill(world_.contents(), btVector3(offset, offset, offset), world.size);
    for (const auto& body : world_.contents().bodies()) {
        movableCount_ += body->isStaticObject() ? 0 : 1;
    }
    firstEnergy_ = energy();
    outcome_.scene = world.name;
    outcome_.broadphase = broadphase.name;
    outcome_.worstPenetration = meter_.deepest(world_.contents());
}

void HardRun::step() {
    bulletPlaces_.clear();
    for (const auto& body : world_.contents().bodies()) {
        bulletPlaces_.push_back(body->getWorldTransform().getOrigin().x());
    }
    world_.step(kStep);
    ++stepCount_;
    state_ = stateHash(world_.contents());
    // FNV-1a's prime spreads what came before.
    outcome_.trajectoryHash = outcome_.trajectoryHash * 0x100000001b3U ^ state_;
    outcome_.energyDrift = std::max(outcome_.energyDrift, energy() - firstEnergy_);
    if (stepCount_ % kStepsPerLook == 0 && sleepingCount_ < movableCount_) {
        outcome_.worstPenetration =
            std::max(outcome_.worstPenetration, meter_.deepest(world_.contents()));
    }
    watchSleep();
    if (hard_.bullets != Bullets::none) {
        watchBullets();
    }
}

double HardRun::energy() const {
    const auto& bodies = world_.contents().bodies();
    double sum = 0;
    for (const auto& body : bodies) {
        if (!body->isStaticObject()) {
            const double height = double{body->getWorldTransform().getOrigin().y()} - hard_.offset;
            sum += kineticEnergy(*body) -
                   double{body->getMass()} * double{body->getGravity().y()} * height;
        }
    }
    return sum;
}

void HardRun::watchSleep() {
    sleepingCount_ = world_.sleepingCount();
    outcome_.sleepingBodySteps += static_cast<std::uint64_t>(sleepingCount_);
    if (sleepingCount_ < movableCount_) {
        outcome_.settleStep = -1;
    } else if (outcome_.settleStep < 0) {
        outcome_.settleStep = stepCount_;
    }
}

void HardRun::watchBullets() {
    const auto bodies = world_.contents().bodies();
    btOverlappingPairCache& pairs = *world_.world().getPairCache();
    const auto bulletCount = static_cast<std::size_t>(hard_.size);
    for (std::size_t i = 0; i < bulletCount; ++i) {
        btRigidBody& wall = *bodies[i];
        btRigidBody& bullet = *bodies[bulletCount + i];
        const btScalar middle = wall.getWorldTransform().getOrigin().x();
        const bool hasCrossed = bulletPlaces_[bulletCount + i] < middle &&
                                bullet.getWorldTransform().getOrigin().x() >= middle;
        const bool isNoticed =
            hard_.bullets == Bullets::pass &&
            pairs.findPair(bullet.getBroadphaseProxy(), wall.getBroadphaseProxy()) != nullptr;
        outcome_.tunnelled += hasCrossed && !isNoticed ? 1 : 0;
    }
}

}  // namespace hashphase::demos
