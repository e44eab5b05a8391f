// SPDX-License-Identifier: Zlib
#include <demos/try/preload/recorder.hpp>

#include <demos/try/preload/overlap.hpp>
#include <demos/try/preload/profile_zones.hpp>
#include <demos/try/preload/program_end.hpp>
#include <demos/try/preload/record_file.hpp>

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>

#include <atomic>
#include <chrono>

#include <pthread.h>
#include <unistd.h>

namespace hashphase::tryout {
namespace {

std::int64_t nanoseconds() noexcept {
    return std::chrono::steady_clock::now().time_since_epoch().count();
}

float milliseconds(std::int64_t nanoseconds) noexcept {
    return static_cast<float>(static_cast<double>(nanoseconds) * 1e-6);
}

std::atomic<Record*> ownRecord = nullptr;
std::atomic<bool> isUncountedFork = false;  // of the recorded process

// A program may start others, which inherit the library: one of them is recorded, and what takes its place
// (exec).
Record* claimRecord() {
    Record* mapped = mappedRecord();
    if (mapped == nullptr) {
        return nullptr;
    }
    std::int32_t holder = 0;
    if (!mapped->process.compare_exchange_strong(holder, getpid()) && holder != getpid()) {
        mapped->otherProcesses.fetch_add(1);
        return nullptr;
    }
    pthread_atfork(nullptr, nullptr, [] {
        ownRecord = nullptr;
        isUncountedFork = true;
    });
    watchQuickExit();
    return mapped;
}

// --- The step under way, of each thread ----------------------------------------------------------

struct Step {
    std::int64_t begin = 0;
    std::int64_t aside = 0;  // what looking at pairs took
    std::int64_t updateAabbs = 0;
    std::int64_t calculate = 0;
    std::int64_t rays = 0;
    std::uint32_t rayCount = 0;
    std::uint32_t calculations = 0;
    std::uint32_t pairCount = 0;
    std::uint32_t truePairCount = 0;
};

thread_local Step current;
thread_local int stepDepth = 0;  // steps hold sub-steps, these a collision detection
thread_local int rayDepth = 0;
thread_local std::int64_t rayTime = 0;  // of this thread's rays that have ended
thread_local std::uint64_t calculationCount = 0;
std::atomic<int> objectCount = 0;
std::atomic<std::int64_t> rayTimeBetween = 0;
std::atomic<std::uint32_t> rayCountBetween = 0;
std::atomic<std::int64_t> firstCalculation = 0;
std::atomic<std::int64_t> lookTime = 0;

// Stands still while rays are cast: callbacks of updateAabbs and calculate may do so, and parts add up.
std::int64_t nanosecondsWithoutRays() noexcept {
    return nanoseconds() - rayTime;
}

void writeRow(Record& into, float stepTime) noexcept {
    const float between = milliseconds(rayTimeBetween.exchange(0));
    const std::uint32_t countBetween = rayCountBetween.exchange(0);
    const std::uint32_t index = into.rowCount.fetch_add(1);
    if (index < Record::kMaxRows) {
        into.rows[index] = {stepTime,
                            milliseconds(current.updateAabbs),
                            milliseconds(current.calculate),
                            milliseconds(current.rays),
                            between,
                            current.rayCount,
                            countBetween,
                            static_cast<std::uint32_t>(objectCount.load()),
                            current.calculations,
                            current.pairCount,
                            current.truePairCount};
    }
    if (stepTime > 0) {
        into.stepCount.fetch_add(1, std::memory_order_release);
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

}  // namespace

// --- What the broadphases call -------------------------------------------------------------------

Record* record() noexcept {
    static const bool isClaimed = [] {
        ownRecord = claimRecord();
        if (ownRecord != nullptr) {
            watchProfileZones();
        }
        return true;
    }();
    static_cast<void>(isClaimed);
    return ownRecord.load(std::memory_order_relaxed);
}

Broadphase wantedBroadphase() noexcept {
    const Record* asked = mappedRecord();
    return asked != nullptr      ? asked->broadphase
           : wasRecordAskedFor() ? Broadphase::stock
                                 : Broadphase::hash;
}

void noteDbvts(int change) {
    if (Record* into = record()) {
        into->dbvtCount.fetch_add(static_cast<std::uint32_t>(change));
    }
}

void noteAxisSweep() {
    if (Record* into = record()) {
        into->axisSweepCount.fetch_add(1);
    }
}

void noteDerivedSweep() {
    if (Record* into = mappedRecord()) {  // and claims nothing: it is not recorded
        into->derivedSweepCount.fetch_add(1);
    }
}

void noteObjects(int change) noexcept {
    objectCount.fetch_add(change, std::memory_order_relaxed);
}

void beginStep() noexcept {
    if (stepDepth++ == 0) {
        current = {};
        current.begin = nanoseconds();
    }
}

// A step in which others' broadphases alone were asked is none of ours, nor does it claim the record.
void endStep() noexcept {
    if (--stepDepth > 0) {
        return;
    }
    Record* into = ownRecord.load(std::memory_order_relaxed);
    if (into != nullptr && current.calculations > 0) {
        writeRow(*into, milliseconds(nanoseconds() - current.begin - current.aside));
    }
    current = {};
}

std::int64_t beginUpdateOfAabbs() noexcept {
    return nanosecondsWithoutRays();
}

void endUpdateOfAabbs(std::int64_t begin) noexcept {
    current.updateAabbs += nanosecondsWithoutRays() - begin;
}

std::uint64_t calculationsOfThread() noexcept {
    return calculationCount;
}

CalculateScope::CalculateScope(btOverlappingPairCache& cache) noexcept
    : cache_(cache), begin_(record() != nullptr ? nanosecondsWithoutRays() : 0) {}

CalculateScope::~CalculateScope() {
    Record* into = record();
    if (into == nullptr) {
        if (isUncountedFork.exchange(false)) {
            mappedRecord()->otherProcesses.fetch_add(1);
        }
        return;
    }
    const std::int64_t now = nanoseconds();
    current.calculate += now - rayTime - begin_;
    ++current.calculations;
    ++calculationCount;
    countPairs(cache_, now);
    if (stepDepth == 0) {
        writeRow(*into, 0);
    }
}

RayScope::RayScope() noexcept
    : begin_(rayDepth++ == 0 && record() != nullptr ? nanoseconds() : 0) {}

RayScope::~RayScope() {
    if (--rayDepth > 0 || begin_ == 0) {
        return;
    }
    const std::int64_t took = nanoseconds() - begin_;
    rayTime += took;
    if (stepDepth > 0) {
        current.rays += took;
        ++current.rayCount;
    } else {
        rayTimeBetween.fetch_add(took, std::memory_order_relaxed);
        rayCountBetween.fetch_add(1, std::memory_order_relaxed);
    }
}

}  // namespace hashphase::tryout
