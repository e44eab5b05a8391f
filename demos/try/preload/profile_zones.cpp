// SPDX-License-Identifier: Zlib
#include <demos/try/preload/recorder.hpp>
#include <demos/try/preload/symbol.hpp>

#include <LinearMath/btQuickprof.h>
#include <LinearMath/btScalar.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <string_view>

namespace hashphase::tryout {
namespace {

struct StockProfile {
    void (*setEnter)(btEnterProfileZoneFunc*) = Next{"_Z31btSetCustomEnterProfileZoneFuncPFvPKcE"};
    void (*setLeave)(btLeaveProfileZoneFunc*) = Next{"_Z31btSetCustomLeaveProfileZoneFuncPFvvE"};
    btEnterProfileZoneFunc* (*enter)() = Next{"_Z32btGetCurrentEnterProfileZoneFuncv"};
    btLeaveProfileZoneFunc* (*leave)() = Next{"_Z32btGetCurrentLeaveProfileZoneFuncv"};

    // What Bullet calls in its zones unless told otherwise, which does nothing.
    btEnterProfileZoneFunc* defaultEnter = enter();
    btLeaveProfileZoneFunc* defaultLeave = leave();
};

const StockProfile& stockProfile() {
    static const StockProfile functions;
    return functions;
}

// What the program has Bullet call; nullptr for the defaults.
std::atomic<btEnterProfileZoneFunc*> programsEnter = nullptr;
std::atomic<btLeaveProfileZoneFunc*> programsLeave = nullptr;
std::atomic<bool> isWatching = false;

// --- Zones ---------------------------------------------------------------------------------------

enum class Zone : std::uint8_t { other, step, updateAabbs, calculate, narrowPhase };

Zone zoneOf(std::string_view name) noexcept {
    return name == "updateAabbs"                 ? Zone::updateAabbs
           : name == "calculateOverlappingPairs" ? Zone::calculate
           : name == "dispatchAllCollisionPairs" ? Zone::narrowPhase
           : name == "internalSingleStepSimulation" || name == "performDiscreteCollisionDetection"
               ? Zone::step
               : Zone::other;
}

struct OpenZone {
    Zone zone = Zone::other;
    PartBegin begin;                 // of updateAabbs and narrowPhase
    std::uint64_t calculations = 0;  // before calculate
};

constexpr std::size_t kMaxDepth = 64;  // deeper ones are not watched
thread_local std::array<OpenZone, kMaxDepth> openZones;
thread_local std::size_t zoneDepth = 0;

void beginZone(const char* name) noexcept {
    const std::size_t depth = zoneDepth++;
    if (depth >= kMaxDepth) {
        return;
    }
    OpenZone& open = openZones[depth];
    open.zone = zoneOf(name);
    if (open.zone == Zone::step) {
        beginStep();
    } else if (open.zone == Zone::updateAabbs || open.zone == Zone::narrowPhase) {
        open.begin = beginPart();
    } else if (open.zone == Zone::calculate) {
        open.calculations = calculationsOfThread();
    }
}

void endZone() noexcept {
    if (zoneDepth == 0 || --zoneDepth >= kMaxDepth) {
        return;
    }
    OpenZone& open = openZones[zoneDepth];
    if (open.zone == Zone::step) {
        endStep();
    } else if (open.zone == Zone::updateAabbs) {
        endPart(Part::updateAabbs, open.begin);
    } else if (open.zone == Zone::narrowPhase) {
        endPart(Part::narrowPhase, open.begin);
    } else if (open.zone == Zone::calculate && open.calculations == calculationsOfThread()) {
        note(&Counts::foreignCalculations);
    }
}

void enterZone(const char* name) {
    beginZone(name);
    if (btEnterProfileZoneFunc* enter = programsEnter.load(std::memory_order_relaxed)) {
        enter(name);
    }
}

void leaveZone() {
    if (btLeaveProfileZoneFunc* leave = programsLeave.load(std::memory_order_relaxed)) {
        leave();
    }
    endZone();
}

}  // namespace

void watchProfileZones() {
    isWatching = true;
    stockProfile().setEnter(&enterZone);
    stockProfile().setLeave(&leaveZone);
}

}  // namespace hashphase::tryout

// --- In place of Bullet's own --------------------------------------------------------------------

using namespace hashphase::tryout;

void btSetCustomEnterProfileZoneFunc(btEnterProfileZoneFunc* enterFunc) {
    programsEnter = enterFunc != stockProfile().defaultEnter ? enterFunc : nullptr;
    if (!isWatching) {
        stockProfile().setEnter(enterFunc);
    }
}

void btSetCustomLeaveProfileZoneFunc(btLeaveProfileZoneFunc* leaveFunc) {
    programsLeave = leaveFunc != stockProfile().defaultLeave ? leaveFunc : nullptr;
    if (!isWatching) {
        stockProfile().setLeave(leaveFunc);
    }
}

btEnterProfileZoneFunc* btGetCurrentEnterProfileZoneFunc() {
    btEnterProfileZoneFunc* const enter = programsEnter;
    return enter != nullptr ? enter : stockProfile().defaultEnter;
}

btLeaveProfileZoneFunc* btGetCurrentLeaveProfileZoneFunc() {
    btLeaveProfileZoneFunc* const leave = programsLeave;
    return leave != nullptr ? leave : stockProfile().defaultLeave;
}

// The name of a member that takes a number, an int and a number.
#ifdef BT_USE_DOUBLE_PRECISION
#define HASHPHASE_STEP_NAME(world) "_ZN" world "14stepSimulationEdid"
#else
#define HASHPHASE_STEP_NAME(world) "_ZN" world "14stepSimulationEfif"
#endif

namespace {

using StepFunction = int(void* world, btScalar timeStep, int maxSubSteps, btScalar fixedTimeStep);

/// Ends by an exception of the program's, too: from a callback of its own, out of Bullet.
class StepScope {
public:
    StepScope() noexcept { beginStep(); }
    ~StepScope() { endStep(); }
    StepScope(const StepScope&) = delete;
    StepScope& operator=(const StepScope&) = delete;
};

}  // namespace

// Stands in for the step of that world.
#define HASHPHASE_STEP(function, world)                                                            \
    StepFunction function asm(HASHPHASE_STEP_NAME(world));                                         \
    int function(void* object, btScalar timeStep, int maxSubSteps, btScalar fixedTimeStep) {       \
        static StepFunction* const stock = Next{HASHPHASE_STEP_NAME(world)};                       \
        const StepScope scope;                                                                     \
        return stock(object, timeStep, maxSubSteps, fixedTimeStep);                                \
    }

extern "C" {

HASHPHASE_STEP(stepDiscreteWorld, "23btDiscreteDynamicsWorld")
HASHPHASE_STEP(stepSimpleWorld, "21btSimpleDynamicsWorld")
HASHPHASE_STEP(stepDeformableWorld, "34btDeformableMultiBodyDynamicsWorld")
}
