// SPDX-License-Identifier: Zlib
#include <demos/compare/observed_world.hpp>

#include <demos/report/stopwatch.hpp>

namespace hashphase::demos {

ObservedWorld::StepTimes ObservedWorld::stepOnce(btScalar seconds) {
    times_ = {};
    observerMs_ = 0;
    const Stopwatch watch;
    // No sub-steps: one step of the given length.
    stepSimulation(seconds, 0);
    times_.wholeMs = watch.milliseconds() - observerMs_;
    return times_;
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

void ObservedWorld::updateAabbs() {
    const HeapScope scope(heap_);
    const Stopwatch watch;
    btDiscreteDynamicsWorld::updateAabbs();
    times_.updateAabbsMs += watch.milliseconds();
}

void ObservedWorld::computeOverlappingPairs() {
    {
        const HeapScope scope(heap_);
        const Stopwatch watch;
        btDiscreteDynamicsWorld::computeOverlappingPairs();
        times_.calculateMs += watch.milliseconds();
    }
    const Stopwatch watch;
    if (observer_) {
        observer_();
    }
    observerMs_ += watch.milliseconds();
}

}  // namespace hashphase::demos
