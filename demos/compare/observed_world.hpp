// SPDX-License-Identifier: Zlib
#pragma once

// A Bullet world that times its broadphase phases and lets someone look in between.

#include <demos/compare/heap_meter.hpp>

#include <btBulletDynamicsCommon.h>

#include <cstddef>
#include <functional>

namespace hashphase::demos {

/// For such worlds: large enough that contacts come from the pools and never from the heap, whose growth is
/// measured around the broadphase. Removing a pair frees its contacts.
[[nodiscard]] btDefaultCollisionConstructionInfo roomyPools();

class ObservedWorld : public btDiscreteDynamicsWorld {
public:
    using btDiscreteDynamicsWorld::btDiscreteDynamicsWorld;

    struct StepTimes {
        double updateAabbsMs = 0;
        double calculateMs = 0;
        double wholeMs = 0;  // without the time of observing
    };

    /// Called in each step when the pairs are complete, before anything uses them.
    void setPairObserver(std::function<void()> observer) { observer_ = std::move(observer); }

    /// Called with the number of objects whenever one has been added; may throw.
    void setAdditionObserver(std::function<void(std::size_t objects)> observer) {
        additionObserver_ = std::move(observer);
    }

    /// The time in which objects were put into the broadphase, their boxes included [ms].
    [[nodiscard]] double additionMs() const noexcept { return additionMs_; }

    /// Simulates exactly one step of that length [s].
    StepTimes stepOnce(btScalar seconds);

    /// Takes the boxes of all objects, as a step does, and puts them nowhere; the world is as before.
    /// Returns the time that no broadphase can save [ms].
    double timeShapeBoxes();

    /// Takes the memory for so many objects beforehand, so that it does not count as the
    /// broadphase's.
    void reserve(std::size_t objects);

    /// What the broadphase took from the heap in the calls of this world.
    [[nodiscard]] HeapMeter& heap() noexcept { return heap_; }
    [[nodiscard]] const HeapMeter& heap() const noexcept { return heap_; }

    void addCollisionObject(btCollisionObject* object, int group, int mask) override;
    void updateAabbs() override;
    void computeOverlappingPairs() override;

private:
    /// Goes through the phase and returns its time [ms]; what is measured around it is observing.
    template <class Phase>
    double timed(const Phase& phase);

    std::function<void()> observer_;
    std::function<void(std::size_t)> additionObserver_;
    double additionMs_ = 0;
    HeapMeter heap_;
    StepTimes times_;
    double observingMs_ = 0;
};

}  // namespace hashphase::demos
