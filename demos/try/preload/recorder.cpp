// SPDX-License-Identifier: Zlib
#include <demos/try/preload/recorder.hpp>

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdlib>

#include <fcntl.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace hashphase::tryout {
namespace {

// --- The record that this process was asked for --------------------------------------------------

// Whether there should be one.
bool wasRecordAskedFor() noexcept {
    static const bool wasAskedFor = std::getenv(kRecordVariable) != nullptr;
    return wasAskedFor;
}

Record* mapRecord() noexcept {
    const char* path = std::getenv(kRecordVariable);
    const int file = path != nullptr ? open(path, O_RDWR | O_CLOEXEC) : -1;
    if (file < 0) {
        return nullptr;
    }
    struct stat status {};
    void* bytes = MAP_FAILED;
    if (fstat(file, &status) == 0 && status.st_size == static_cast<off_t>(sizeof(Record))) {
        bytes = mmap(nullptr, sizeof(Record), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    }
    close(file);
    auto* mapped = static_cast<Record*>(bytes);
    if (bytes == MAP_FAILED || mapped->format != Record::kFormat) {
        return nullptr;
    }
    mapped->isLoaded = 1;
    return mapped;
}

// nullptr where none was asked for, or it cannot be had.
Record* mappedRecord() noexcept {
    static Record* const mapped = mapRecord();
    return mapped;
}

// When the library is loaded: the program may change its folder, its root or its rights later.
[[gnu::constructor]] void mapEarly() {
    static_cast<void>(mappedRecord());
}

// By exit(), by the end of main(), by _exit() or _Exit() and, once it is watched, by quick_exit(); a signal, or
// another program in its place, leave it. Whoever has started the process may not tell. Forks of the recorded
// process have its record, and another number.
[[gnu::destructor]] void noteEnd() {
    if (Record* into = mappedRecord(); into != nullptr && into->process.load() == getpid()) {
        into->hasEnded = 1;
    }
}

[[noreturn]] void endWithoutDestructors(int status) noexcept {
    noteEnd();
    for (;;) {
        syscall(SYS_exit_group, status);
    }
}

float milliseconds(std::int64_t nanoseconds) noexcept {
    return static_cast<float>(static_cast<double>(nanoseconds) * 1e-6);
}

Times millisecondsOf(const ClockTimes& took) noexcept {
    return {milliseconds(took.wall), milliseconds(took.processor)};
}

void add(std::uint32_t& count, int change = 1) noexcept {
    std::atomic_ref(count).fetch_add(static_cast<std::uint32_t>(change));
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
        add(mapped->counts.otherProcesses);
        return nullptr;
    }
    pthread_atfork(nullptr, nullptr, [] {
        ownRecord = nullptr;
        isUncountedFork = true;
    });
    static_cast<void>(std::at_quick_exit(&noteEnd));  // fails where there are too many
    return mapped;
}

// --- The step under way, of each thread ----------------------------------------------------------

constexpr std::int64_t kNotTaken = -1;

struct Step {
    ClockTimes begin;
    std::int64_t looksBefore = 0;
    std::int64_t allBegin = kNotTaken;  // of all threads
    ClockTimes aside;                   // what looking at pairs took
    std::array<ClockTimes, kPartCount> parts;
    std::int64_t rays = 0;
    std::uint32_t rayCount = 0;
    std::uint32_t calculations = 0;
    std::uint32_t pairCount = 0;
    std::uint32_t truePairCount = 0;

    [[nodiscard]] ClockTimes& part(Part which) noexcept {
        return parts[static_cast<std::size_t>(which)];
    }
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

void writeRow(Record& into, bool isStep, const ClockTimes& step, float allProcessor) noexcept {
    const float between = milliseconds(rayTimeBetween.exchange(0));
    const std::uint32_t countBetween = rayCountBetween.exchange(0);
    const std::uint32_t index = into.rowCount.fetch_add(1);
    if (index < Record::kMaxRows) {
        into.rows[index] = {isStep ? 1U : 0U,
                            millisecondsOf(step),
                            millisecondsOf(current.part(Part::updateAabbs)),
                            millisecondsOf(current.part(Part::calculate)),
                            millisecondsOf(current.part(Part::narrowPhase)),
                            allProcessor,
                            milliseconds(current.rays),
                            between,
                            current.rayCount,
                            countBetween,
                            static_cast<std::uint32_t>(objectCount.load()),
                            current.calculations,
                            current.pairCount,
                            current.truePairCount};
    }
    if (isStep) {
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

// Looks at the pairs if that keeps looking below 5 ms, for short programs, and a two-hundredth of all time so far.
void countPairs(btOverlappingPairCache& cache) {
    constexpr std::int64_t kShare = 200;
    constexpr std::int64_t kFree = 5'000'000;
    current.pairCount += static_cast<std::uint32_t>(cache.getNumOverlappingPairs());
    const ClockTimes now = beginMoment();
    std::int64_t none = 0;
    firstCalculation.compare_exchange_strong(none, now.wall);
    if (current.truePairCount == StepRow::kNotCounted ||
        (lookTime.load() - kFree) * kShare > now.wall - firstCalculation.load()) {
        current.truePairCount = StepRow::kNotCounted;
        return;
    }
    current.truePairCount += countTruePairs(cache);
    const ClockTimes took = endMoment() - now;
    lookTime += took.wall;
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

void note(std::uint32_t Counts::*count, int change) {
    if (Record* into = record()) {
        add(into->counts.*count, change);
    }
}

void noteDerivedSweep() {
    if (Record* into = mappedRecord()) {  // and claims nothing: it is not recorded
        add(into->counts.derivedSweeps);
    }
}

void noteObjects(int change) noexcept {
    objectCount.fetch_add(change, std::memory_order_relaxed);
}

void beginStep() noexcept {
    constexpr std::uint32_t kStepsBetweenLooks = 8;
    thread_local std::uint32_t stepNumber = 0;
    if (stepDepth++ == 0) {
        current = {};
        if (stepNumber++ % kStepsBetweenLooks == 1) {  // not at first, when a look takes longest
            current.allBegin = allProcessorNanoseconds();
        }
        current.begin = beginMoment();
        current.looksBefore = nanosecondsOfLooks();
    }
}

// A step in which others' broadphases alone were asked is none of ours, nor does it claim the record.
void endStep() noexcept {
    if (--stepDepth > 0) {
        return;
    }
    Record* into = ownRecord.load(std::memory_order_relaxed);
    if (into != nullptr && current.calculations > 0) {
        const std::int64_t looks = nanosecondsOfLooks() - current.looksBefore;
        const ClockTimes step =
            endMoment() - current.begin - current.aside - ClockTimes{looks, looks};
        const float all = current.allBegin == kNotTaken
                              ? StepRow::kNotTaken
                              : milliseconds(allProcessorNanoseconds() - current.allBegin -
                                             current.aside.processor);
        writeRow(*into, true, step, all);
    }
    current = {};
}

PartBegin beginPart() noexcept {
    return {beginMoment(), rayTime};
}

// Rays take the same share of either clock: callbacks of a part may cast some, and parts add up.
void endPart(Part part, const PartBegin& begin) noexcept {
    ClockTimes took = endMoment() - begin.moment;
    if (const std::int64_t rays = rayTime - begin.rays; rays > 0 && took.wall > 0) {
        const double share = static_cast<double>(rays) / static_cast<double>(took.wall);
        const double processor = share * static_cast<double>(took.processor);
        took = took - ClockTimes{rays, static_cast<std::int64_t>(processor)};
    }
    current.part(part) += took;
}

std::uint64_t calculationsOfThread() noexcept {
    return calculationCount;
}

CalculateScope::CalculateScope(btOverlappingPairCache& cache) noexcept
    : cache_(cache), begin_(record() != nullptr ? beginPart() : PartBegin{}) {}

CalculateScope::~CalculateScope() {
    Record* into = record();
    if (into == nullptr) {
        if (isUncountedFork.exchange(false)) {
            add(mappedRecord()->counts.otherProcesses);
        }
        return;
    }
    endPart(Part::calculate, begin_);
    ++current.calculations;
    ++calculationCount;
    countPairs(cache_);
    if (stepDepth == 0) {
        writeRow(*into, false, {}, StepRow::kNotTaken);
    }
}

RayScope::RayScope() noexcept
    : begin_(rayDepth++ == 0 && record() != nullptr ? wallNanoseconds() : 0) {}

RayScope::~RayScope() {
    if (--rayDepth > 0 || begin_ == 0) {
        return;
    }
    const std::int64_t took = wallNanoseconds() - begin_;
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

// In place of those of the C library, which run nothing of ours.
extern "C" {

void _exit(int status) {
    hashphase::tryout::endWithoutDestructors(status);
}

void _Exit(int status) noexcept {
    hashphase::tryout::endWithoutDestructors(status);
}
}
