// SPDX-License-Identifier: Zlib
#include <demos/try/preload/recorder.hpp>

#include <demos/try/preload/overlap.hpp>
#include <demos/try/preload/symbol.hpp>

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <LinearMath/btQuickprof.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <cstring>

#include <fcntl.h>
#include <pthread.h>
#include <sys/mman.h>
#include <unistd.h>

namespace hashphase::tryout {
namespace {

std::int64_t nanoseconds() noexcept {
    return std::chrono::steady_clock::now().time_since_epoch().count();
}

float milliseconds(std::int64_t nanoseconds) noexcept {
    return static_cast<float>(static_cast<double>(nanoseconds) * 1e-6);
}

// --- The record ----------------------------------------------------------------------------------

Record* mapRecord() noexcept {
    const char* path = std::getenv(kRecordVariable);
    const int file = path != nullptr ? open(path, O_RDWR | O_CLOEXEC) : -1;
    if (file < 0) {
        return nullptr;
    }
    void* bytes = mmap(nullptr, sizeof(Record), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    close(file);
    if (bytes == MAP_FAILED) {
        return nullptr;
    }
    auto* mapped = static_cast<Record*>(bytes);
    return mapped->format == Record::kFormat ? mapped : nullptr;
}

std::atomic<Record*> ownRecord = nullptr;

// A program may start others, which inherit the library: one of them is recorded.
Record* claimRecord() {
    Record* mapped = mapRecord();
    if (mapped == nullptr) {
        return nullptr;
    }
    std::int32_t nobody = 0;
    if (!mapped->process.compare_exchange_strong(nobody, getpid())) {
        mapped->otherProcesses.fetch_add(1);
        return nullptr;
    }
    pthread_atfork(nullptr, nullptr, [] { ownRecord = nullptr; });
    return mapped;
}

// --- The step under way, of each thread ----------------------------------------------------------

struct Step {
    std::int64_t begin = 0;
    std::int64_t aside = 0;  // what looking at pairs took
    std::int64_t updateAabbs = 0;
    std::int64_t calculate = 0;
    std::uint32_t calculations = 0;
    std::uint32_t pairCount = 0;
    std::uint32_t truePairCount = 0;
};

thread_local Step current;
thread_local int rayDepth = 0;
std::atomic<int> objectCount = 0;
std::atomic<std::int64_t> rayTime = 0;  // since the last row
std::atomic<std::uint32_t> rayCount = 0;
std::atomic<std::uint32_t> startedRows = 0;
std::atomic<std::int64_t> firstCalculation = 0;
std::atomic<std::int64_t> lookTime = 0;

void writeRow(Record& into, float stepTime) noexcept {
    const std::int64_t rays = rayTime.exchange(0, std::memory_order_relaxed);
    const std::uint32_t cast = rayCount.exchange(0, std::memory_order_relaxed);
    const std::uint32_t index = startedRows.fetch_add(1, std::memory_order_relaxed);
    if (index < into.stepLimit) {
        into.rows[index] = {stepTime,
                            milliseconds(current.updateAabbs),
                            milliseconds(current.calculate),
                            milliseconds(rays),
                            cast,
                            static_cast<std::uint32_t>(objectCount.load()),
                            current.pairCount,
                            current.truePairCount};
        into.rowCount.fetch_add(1, std::memory_order_release);
    }
    current = {};
}

std::uint32_t countTruePairs(btOverlappingPairCache& cache) {
    const btOverlappingPairCache& asItStands = cache;
    const btBroadphasePair* pairs = asItStands.getOverlappingPairArrayPtr();
    const int count = cache.getNumOverlappingPairs();
    std::uint32_t overlapping = 0;
    for (int i = 0; i < count; ++i) {
        overlapping += overlaps(*pairs[i].m_pProxy0, *pairs[i].m_pProxy1) ? 1 : 0;
    }
    return overlapping;
}

// Looks at the pairs if that keeps looking below a two-hundredth of all time so far.
void countPairs(btOverlappingPairCache& cache, std::int64_t now) {
    constexpr std::int64_t kShare = 200;
    current.pairCount += static_cast<std::uint32_t>(cache.getNumOverlappingPairs());
    std::int64_t none = 0;
    firstCalculation.compare_exchange_strong(none, now);
    if (current.truePairCount == StepRow::kNotCounted ||
        lookTime.load() * kShare > now - firstCalculation.load()) {
        current.truePairCount = StepRow::kNotCounted;
        return;
    }
    current.truePairCount += countTruePairs(cache);
    const std::int64_t took = nanoseconds() - now;
    lookTime += took;
    current.aside += took;
}

// --- Bullet's profile zones ----------------------------------------------------------------------

enum class Zone : std::uint8_t { other, step, updateAabbs, calculate };

Zone zoneOf(const char* name) noexcept {
    switch (name[0]) {
        case 's':
            return std::strcmp(name, "stepSimulation") == 0 ? Zone::step : Zone::other;
        case 'p':
            return std::strcmp(name, "performDiscreteCollisionDetection") == 0 ? Zone::step
                                                                               : Zone::other;
        case 'u':
            return std::strcmp(name, "updateAabbs") == 0 ? Zone::updateAabbs : Zone::other;
        case 'c':
            return std::strcmp(name, "calculateOverlappingPairs") == 0 ? Zone::calculate
                                                                       : Zone::other;
        default:
            return Zone::other;
    }
}

struct OpenZone {
    Zone zone = Zone::other;
    std::int64_t begin = 0;
    std::uint32_t calculations = 0;  // of the step, when it began
};

constexpr std::size_t kMaxDepth = 64;  // deeper ones are not timed
thread_local std::array<OpenZone, kMaxDepth> openZones;
thread_local std::size_t zoneDepth = 0;
thread_local int stepDepth = 0;  // a step holds a collision detection

std::atomic<btEnterProfileZoneFunc*> programsEnter = nullptr;
std::atomic<btLeaveProfileZoneFunc*> programsLeave = nullptr;

void beginZone(const char* name) noexcept {
    const std::size_t depth = zoneDepth++;
    if (depth >= kMaxDepth) {
        return;
    }
    const Zone zone = zoneOf(name);
    openZones[depth] = {zone, zone != Zone::other ? nanoseconds() : 0, current.calculations};
    if (zone == Zone::step && stepDepth++ == 0) {
        current.begin = openZones[depth].begin;
    }
}

void endZone() noexcept {
    if (zoneDepth == 0 || --zoneDepth >= kMaxDepth) {
        return;
    }
    const OpenZone& open = openZones[zoneDepth];
    Record* into = record();
    if (into == nullptr || open.zone == Zone::other) {
        return;
    }
    if (open.zone == Zone::updateAabbs) {
        current.updateAabbs += nanoseconds() - open.begin;
    } else if (open.zone == Zone::calculate) {
        if (open.calculations == current.calculations) {
            into->foreignCalculations.fetch_add(1, std::memory_order_relaxed);
        }
    } else if (--stepDepth == 0 && current.calculations > 0) {
        writeRow(*into, milliseconds(nanoseconds() - current.begin - current.aside));
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

struct Watch {
    Watch() {
        ownRecord = claimRecord();
        if (ownRecord != nullptr) {
            programsEnter = stockProfile().enter();
            programsLeave = stockProfile().leave();
            stockProfile().setEnter(&enterZone);
            stockProfile().setLeave(&leaveZone);
        }
    }
};

}  // namespace

// --- What the broadphases call -------------------------------------------------------------------

Record* record() noexcept {
    static const Watch watch;
    return ownRecord.load(std::memory_order_relaxed);
}

Broadphase wantedBroadphase() noexcept {
    static const Broadphase wanted = [] {
        const Record* asked = record();
        return asked != nullptr ? asked->broadphase : Broadphase::hash;
    }();
    return wanted;
}

void noteDbvt() {
    if (Record* into = record()) {
        into->dbvtCount.fetch_add(1);
    }
}

void noteAxisSweep(bool hasMadeDbvt) {
    if (Record* into = record()) {
        into->axisSweepCount.fetch_add(1);
        into->dbvtCount.fetch_sub(hasMadeDbvt ? 1 : 0);
    }
}

void noteObjects(int change) noexcept {
    objectCount.fetch_add(change, std::memory_order_relaxed);
}

CalculateScope::CalculateScope(btOverlappingPairCache& cache) noexcept
    : cache_(cache), begin_(record() != nullptr ? nanoseconds() : 0) {}

CalculateScope::~CalculateScope() {
    Record* into = record();
    if (into == nullptr) {
        return;
    }
    const std::int64_t now = nanoseconds();
    current.calculate += now - begin_;
    ++current.calculations;
    countPairs(cache_, now);
    if (stepDepth == 0) {
        writeRow(*into, 0);
    }
}

RayScope::RayScope() noexcept
    : begin_(rayDepth++ == 0 && record() != nullptr ? nanoseconds() : 0) {}

RayScope::~RayScope() {
    if (--rayDepth == 0 && begin_ != 0) {
        rayTime.fetch_add(nanoseconds() - begin_, std::memory_order_relaxed);
        rayCount.fetch_add(1, std::memory_order_relaxed);
    }
}

}  // namespace hashphase::tryout

// --- In place of Bullet's own --------------------------------------------------------------------

// A program that watches the zones itself goes on doing so, behind us.
void btSetCustomEnterProfileZoneFunc(btEnterProfileZoneFunc* enterFunc) {
    using namespace hashphase::tryout;
    if (record() != nullptr) {
        programsEnter = enterFunc;
    } else {
        stockProfile().setEnter(enterFunc);
    }
}

void btSetCustomLeaveProfileZoneFunc(btLeaveProfileZoneFunc* leaveFunc) {
    using namespace hashphase::tryout;
    if (record() != nullptr) {
        programsLeave = leaveFunc;
    } else {
        stockProfile().setLeave(leaveFunc);
    }
}

btEnterProfileZoneFunc* btGetCurrentEnterProfileZoneFunc() {
    using namespace hashphase::tryout;
    return record() != nullptr ? programsEnter.load() : stockProfile().enter();
}

btLeaveProfileZoneFunc* btGetCurrentLeaveProfileZoneFunc() {
    using namespace hashphase::tryout;
    return record() != nullptr ? programsLeave.load() : stockProfile().leave();
}
