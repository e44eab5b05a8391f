// SPDX-License-Identifier: Zlib
#include <demos/try/preload/profile_zones.hpp>

#include <demos/try/preload/recorder.hpp>
#include <demos/try/preload/symbol.hpp>

#include <LinearMath/btQuickprof.h>
#include <LinearMath/btScalar.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstring>

namespace hashphase::tryout {
namespace {

struct StockProfile {
    void (*setEnter)(btEnterProfileZoneFunc*) = Next{"_Z31btSetCustomEnterProfileZoneFuncPFvPKcE"};
    void (*setLeave)(btLeaveProfileZoneFunc*) = Next{"_Z31btSetCustomLeaveProfileZoneFuncPFvvE"};
    btEnterProfileZoneFunc* (*enter)() = Next{"_Z32btGetCurrentEnterProfileZoneFuncv"};
    btLeaveProfileZoneFunc* (*leave)() = Next{"_Z32btGetCurrentLeaveProfileZoneFuncv"};
};

const StockProfile& stockProfile() {
    static const StockProfile functions;
    return functions;
}

// What Bullet calls in its zones unless told otherwise, which does nothing.
struct Defaults {
    btEnterProfileZoneFunc* enter = stockProfile().enter();
    btLeaveProfileZoneFunc* leave = stockProfile().leave();
};

const Defaults& defaults() {
    static const Defaults functions;
    return functions;
}

// What the program has Bullet call; nullptr for the defaults.
std::atomic<btEnterProfileZoneFunc*> programsEnter = nullptr;
std::atomic<btLeaveProfileZoneFunc*> programsLeave = nullptr;
std::atomic<bool> isWatching = false;

// --- Zones ---------------------------------------------------------------------------------------

enum class Zone : std::uint8_t { other, step, updateAabbs, calculate, narrowPhase };

Zone zoneOf(const char* name) noexcept {
    const auto is = [name](const char* zone) { return std::strcmp(name, zone) == 0; };
    switch (name[0]) {
        case 'i':
            return is("internalSingleStepSimulation") ? Zone::step : Zone::other;
        case 'p':
            return is("performDiscreteCollisionDetection") ? Zone::step : Zone::other;
        case 'u':
            return is("updateAabbs") ? Zone::updateAabbs : Zone::other;
        case 'd':
            return is("dispatchAllCollisionPairs") ? Zone::narrowPhase : Zone::other;
        case 'c':
            return is("calculateOverlappingPairs") ? Zone::calculate : Zone::other;
        default:
            return Zone::other;
    }
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
        if (Record* into = record()) {
            into->foreignCalculations.fetch_add(1, std::memory_order_relaxed);
        }
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
    static_cast<void>(defaults());
    isWatching = true;
    stockProfile().setEnter(&enterZone);
    stockProfile().setLeave(&leaveZone);
}

}  // namespace hashphase::tryout

// --- In place of Bullet's own --------------------------------------------------------------------

using namespace hashphase::tryout;

void btSetCustomEnterProfileZoneFunc(btEnterProfileZoneFunc* enterFunc) {
    programsEnter = enterFunc != defaults().enter ? enterFunc : nullptr;
    if (!isWatching) {
        stockProfile().setEnter(enterFunc);
    }
}

void btSetCustomLeaveProfileZoneFunc(btLeaveProfileZoneFunc* leaveFunc) {
    programsLeave = leaveFunc != defaults().leave ? leaveFunc : nullptr;
    if (!isWatching) {
        stockProfile().setLeave(leaveFunc);
    }
}

btEnterProfileZoneFunc* btGetCurrentEnterProfileZoneFunc() {
    btEnterProfileZoneFunc* const enter = programsEnter;
    return enter != nullptr ? enter : defaults().enter;
}

btLeaveProfileZoneFunc* btGetCurrentLeaveProfileZoneFunc() {
    btLeaveProfileZoneFunc* const leave = programsLeave;
    return leave != nullptr ? leave : defaults().leave;
}

// The name of a member that takes a number, an int and a number.
#ifdef BT_USE_DOUBLE_PRECISION
#define HASHPHASE_STEP(world) "_ZN" world "14stepSimulationEdid"
#else
#define HASHPHASE_STEP(world) "_ZN" world "14stepSimulationEfif"
#endif
#define HASHPHASE_STEP_DISCRETE HASHPHASE_STEP("23btDiscreteDynamicsWorld")
#define HASHPHASE_STEP_SIMPLE HASHPHASE_STEP("21btSimpleDynamicsWorld")
#define HASHPHASE_STEP_DEFORMABLE HASHPHASE_STEP("34btDeformableMultiBodyDynamicsWorld")

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

int step(StepFunction* stock, void* world, btScalar timeStep, int maxSubSteps,
         btScalar fixedTimeStep) {
    const StepScope scope;
    // cppcheck-suppress CastAddressToIntegerAtReturn; takes the function's type for a pointer
    return stock(world, timeStep, maxSubSteps, fixedTimeStep);
}

}  // namespace

extern "C" {

StepFunction stepDiscreteWorld asm(HASHPHASE_STEP_DISCRETE);
StepFunction stepSimpleWorld asm(HASHPHASE_STEP_SIMPLE);
StepFunction stepDeformableWorld asm(HASHPHASE_STEP_DEFORMABLE);

int stepDiscreteWorld(void* world, btScalar timeStep, int maxSubSteps, btScalar fixedTimeStep) {
    static StepFunction* const stock = Next{HASHPHASE_STEP_DISCRETE};
    return step(stock, world, timeStep, maxSubSteps, fixedTimeStep);
}

int stepSimpleWorld(void* world, btScalar timeStep, int maxSubSteps, btScalar fixedTimeStep) {
    static StepFunction* const stock = Next{HASHPHASE_STEP_SIMPLE};
    return step(stock, world, timeStep, maxSubSteps, fixedTimeStep);
}

int stepDeformableWorld(void* world, btScalar timeStep, int maxSubSteps, btScalar fixedTimeStep) {
    static StepFunction* const stock = Next{HASHPHASE_STEP_DEFORMABLE};
    return step(stock, world, timeStep, maxSubSteps, fixedTimeStep);
}
}
