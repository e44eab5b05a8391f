// SPDX-License-Identifier: Zlib
#include <demos/scenes/hard_run.hpp>

#include <algorithm>

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

}  // namespace

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
