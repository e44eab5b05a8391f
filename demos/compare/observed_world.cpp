// SPDX-License-Identifier: Zlib
#include <demos/compare/observed_world.hpp>

#include <demos/report/stopwatch.hpp>

namespace hashphase::demos {
namespace {

/// Keeps no box that it is given.
class NoBoxes : public btSimpleBroadphase {
    using btSimpleBroadphase::btSimpleBroadphase;
    void setAabb(btBroadphaseProxy* /*proxy*/, const btVector3& /*low*/, const btVector3& /*high*/,
                 btDispatcher* /*dispatcher*/) override {}
};

}  // namespace

btDefaultCollisionConstructionInfo roomyPools() {
    btDefaultCollisionConstructionInfo info;
    info.m_defaultMaxPersistentManifoldPoolSize = 16'384;
    info.m_defaultMaxCollisionAlgorithmPoolSize = 16'384;
    return info;
}

ObservedWorld::StepTimes ObservedWorld::stepOnce(btScalar seconds) {
    times_ = {};
    observingMs_ = 0;
    const Stopwatch watch;
    // No sub-steps: one step of the given length.
    stepSimulation(seconds, 0);
    times_.wholeMs = watch.milliseconds() - observingMs_;
    return times_;
}

double ObservedWorld::timeShapeBoxes() {
    NoBoxes nowhere(1);
    btBroadphaseInterface* const broadphase = getBroadphase();
    setBroadphase(&nowhere);
    const Stopwatch watch;
    btDiscreteDynamicsWorld::updateAabbs();
    const double taken = watch.milliseconds();
    setBroadphase(broadphase);
    return taken;
}

void ObservedWorld::reserve(std::size_t objects) {
    m_collisionObjects.reserve(static_cast<int>(objects));
    m_nonStaticRigidBodies.reserve(static_cast<int>(objects));
}

void ObservedWorld::addCollisionObject(btCollisionObject* object, int group, int mask) {
    {
        const HeapScope scope(heap_);
        const Stopwatch watch;
        btDiscreteDynamicsWorld::addCollisionObject(object, group, mask);
        additionMs_ += watch.milliseconds();
    }
    if (additionObserver_) {
        additionObserver_(static_cast<std::size_t>(m_collisionObjects.size()));
    }
}

template <class Phase>
double ObservedWorld::timed(const Phase& phase) {
    const Stopwatch around;
    double taken = 0;
    {
        const HeapScope scope(heap_);
        const Stopwatch watch;
        phase();
        taken = watch.milliseconds();
    }
    observingMs_ += around.milliseconds() - taken;
    return taken;
}

void ObservedWorld::updateAabbs() {
    times_.updateAabbsMs += timed([this] { btDiscreteDynamicsWorld::updateAabbs(); });
}

void ObservedWorld::computeOverlappingPairs() {
    times_.calculateMs += timed([this] { btDiscreteDynamicsWorld::computeOverlappingPairs(); });
    const Stopwatch watch;
    if (observer_) {
        observer_();
    }
    observingMs_ += watch.milliseconds();
}

}  // namespace hashphase::demos
