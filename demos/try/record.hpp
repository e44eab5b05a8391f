// SPDX-License-Identifier: Zlib
#pragma once

// What is learned about a program that is tried, while it runs: a file that two processes map, the
// program `hashphase` and the program that it tries, in which a preloaded library writes. What was
// written survives however the program ends.
//
// A step   is a call of stepSimulation() in which pairs were calculated, with all its sub-steps; where
//          Bullet is linked so that its functions cannot be stood in for (-Bsymbolic-functions), one of
//          these sub-steps; and a performDiscreteCollisionDetection() outside of both.
// Threads  counters are added to atomically, a row is one thread's; the verification is added up under a lock.
// Units    milliseconds. Rays are timed by the clock on the wall alone: to look at the other takes longer.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace hashphase::tryout {

/// The environment variable that names the file.
inline constexpr const char* kRecordVariable = "HASHPHASE_TRY_RECORD";

enum class Broadphase : std::uint32_t {
    stock,      // Bullet's own, watched
    hash,       // ours in its place
    verifying,  // ours in its place, Bullet's beside it, both compared with the exact pairs
};

/// How long something took one thread, by two clocks.
struct Times {
    float wall;
    float processor;  // the thread's own: stands still while others run, or the thread waits
};

/// A step of one thread, over all worlds in it; or pairs that were calculated outside of any.
struct StepRow {
    static constexpr std::uint32_t kNotCounted = 0xffffffffU;
    static constexpr float kNotTaken = -1;

    std::uint32_t isStep;  // 0: pairs were calculated outside of steps, and `step` is 0
    Times step;
    Times updateAabbs;
    Times calculate;
    Times narrowPhase;   // dispatchAllCollisionPairs()
    float allProcessor;  // of all threads during the step; kNotTaken in most steps: it takes time
    float rays;          // in the step, what their callbacks do included; on the wall
    float raysBetween;   // since the last row, outside of steps or on threads that make none
    std::uint32_t rayCount;
    std::uint32_t rayBetweenCount;
    std::uint32_t objectCount;
    std::uint32_t calculations;   // 0: not written to the end
    std::uint32_t pairCount;      // after each calculation, in all
    std::uint32_t truePairCount;  // whose boxes overlap; kNotCounted in most steps: it takes time
};

/// What was verified, by the pairs of all calculations together.
struct Verification {
    std::uint64_t calculations = 0;
    std::uint64_t pairs = 0;
    std::uint64_t missing = 0;
    std::uint64_t extra = 0;
    std::uint64_t unasked = 0;  // the filter would take them now, but nothing has moved
    std::uint64_t removed = 0;  // by the program, out of the cache
    std::uint64_t late = 0;     // overlap, but a callback has moved one meanwhile: not judged
    std::uint64_t stockPairs = 0;
    std::uint64_t stockMissing = 0;
    std::uint64_t stockExtra = 0;
    std::array<char, 480> firstFault{};  // of ours; empty: none
};

/// The counts of a verification, as reports call them.
struct VerifiedCount {
    const char* name;
    std::uint64_t Verification::*count;
};
inline constexpr std::array kVerifiedCounts{
    VerifiedCount{"calculations", &Verification::calculations},
    VerifiedCount{"pairs", &Verification::pairs},
    VerifiedCount{"missing", &Verification::missing},
    VerifiedCount{"extra", &Verification::extra},
    VerifiedCount{"waitForAMove", &Verification::unasked},
    VerifiedCount{"removedByProgram", &Verification::removed},
    VerifiedCount{"notJudged", &Verification::late},
    VerifiedCount{"bulletPairs", &Verification::stockPairs},
    VerifiedCount{"bulletMissing", &Verification::stockMissing},
    VerifiedCount{"bulletExtra", &Verification::stockExtra},
};

struct Counts {
    std::uint32_t dbvts;
    std::uint32_t axisSweeps;
    std::uint32_t derivedSweeps;        // which are not taken over
    std::uint32_t foreignCalculations;  // of broadphases that are not taken over
    std::uint32_t otherProcesses;
};

struct Record {
    static constexpr std::uint32_t kMaxRows = 200'000;
    static constexpr std::uint32_t kFormat = 5;

    // Asked for.
    std::uint32_t format;
    Broadphase broadphase;

    // Answered.
    std::atomic<std::uint32_t> isLoaded;  // into a process at all
    std::atomic<std::int32_t> process;    // who made the first broadphase, by its own number
    std::atomic<std::uint32_t> hasEnded;  // that process, by exit() or its like
    Counts counts;
    std::atomic<std::uint32_t> stepCount;
    std::atomic<std::uint32_t> rowCount;  // those that had no room left included
    Verification verification;
    std::array<StepRow, kMaxRows> rows;
};

static_assert(std::atomic<std::uint32_t>::is_always_lock_free);

}  // namespace hashphase::tryout
