// SPDX-License-Identifier: Zlib
#pragma once

// What is learned about a program that is tried, while it runs: a file that two processes map, the
// program `hashphase` and the program that it tries, in which a preloaded library writes. What was
// written survives however the program ends.
//
// Threads  the counters are atomic; a row is written before `rowCount` counts it.
// Units    milliseconds; steps are calls of stepSimulation() in which pairs were calculated, or, of a
//          program that makes none, calls of calculateOverlappingPairs().

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

/// A step, over all worlds in it.
struct StepRow {
    static constexpr std::uint32_t kNotCounted = 0xffffffffU;

    float step;  // stepSimulation(); 0 where there is none
    float updateAabbs;
    float calculate;
    float rays;  // what their callbacks do included
    std::uint32_t rayCount;
    std::uint32_t objectCount;
    std::uint32_t pairCount;
    std::uint32_t truePairCount;  // whose boxes overlap; kNotCounted in most steps: it takes time
};

/// What was verified, by the pairs that were wrong in all steps together.
struct Verification {
    std::atomic<std::uint64_t> calculations;
    std::atomic<std::uint64_t> pairs;
    std::atomic<std::uint64_t> missing;
    std::atomic<std::uint64_t> extra;
    std::atomic<std::uint64_t> unasked;  // the filter would take them now, but nothing has moved
    std::atomic<std::uint64_t> stockMissing;
    std::atomic<std::uint64_t> stockExtra;
    std::array<char, 480> firstFault;  // of ours; empty: none
};

struct Record {
    static constexpr std::uint32_t kMaxRows = 200'000;
    static constexpr std::uint32_t kFormat = 1;

    // Asked for.
    std::uint32_t format;
    Broadphase broadphase;
    std::uint32_t stepLimit;  // so many rows are written; at most kMaxRows

    // Answered.
    std::atomic<std::int32_t> process;  // who made the first broadphase
    std::atomic<std::uint32_t> otherProcesses;
    std::atomic<std::uint32_t> dbvtCount;
    std::atomic<std::uint32_t> axisSweepCount;
    std::atomic<std::uint32_t> foreignCalculations;  // of broadphases that were not taken over
    std::atomic<std::uint32_t> rowCount;
    Verification verification;
    std::array<StepRow, kMaxRows> rows;
};

static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

}  // namespace hashphase::tryout
