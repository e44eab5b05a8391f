// SPDX-License-Identifier: Zlib
#pragma once

// What is asked of every contestant in a frame: to keep the pairs, to cast rays, to change the
// population. What runs the workload knows nothing of it but its answers.
//
// Order    add() for each contestant; then for each frame beginFrame(), runFrame() once for each
//          contestant, in any order, and endFrame() for each.
// Answers  are numbers: a pair's two objects, or a query and an object that it found. Every answer
//          that a contestant gives is compared with the exact ones.

#include <demos/compare/heap_meter.hpp>
#include <tests/benchmarks/contestant.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace hashphase::benchmarks {

/// A pair of objects, or the number of a query in the upper half and its find in the lower.
using Answer = std::uint64_t;

/// What a contestant holds, as far as anyone can tell.
struct Memory {
    /// Taken from the heap while filling and warming up, with the tables by which the measurement
    /// finds an object's proxy (up to 12 bytes an object).
    std::optional<std::int64_t> heapBytes;
    std::optional<OwnBytes> own;
};

class Workload {
public:
    Workload() = default;
    Workload(const Workload&) = delete;
    Workload& operator=(const Workload&) = delete;
    virtual ~Workload() = default;

    /// Makes the contestant and fills it.
    virtual void add(const ContestantKind& kind) = 0;

    /// Draws the next frame; the first call shows the initial state.
    virtual void beginFrame() = 0;

    /// Lets the contestant do its frame and returns the time [ms].
    virtual double runFrame(std::size_t contestant) = 0;

    /// The same while the contestant's heap is watched, which costs time of its own.
    virtual void runWatchedFrame(std::size_t contestant) { runFrame(contestant); }

    /// Replaces `answers` by those of the contestant's last frame, in any order. For before endFrame().
    virtual void listAnswers(std::size_t contestant, std::vector<Answer>& answers) = 0;

    /// Replaces `answers` by the exact ones, sorted.
    virtual void listExactAnswers(std::vector<Answer>& answers) = 0;

    /// What is left to do after a frame and not part of it.
    virtual void endFrame(std::size_t /*contestant*/) {}

    [[nodiscard]] virtual Memory memory(std::size_t /*contestant*/) const { return {}; }

    [[nodiscard]] virtual std::size_t objects() const = 0;

    /// By how many a frame's time is divided: objects, rays, removals.
    [[nodiscard]] virtual std::size_t operations() const = 0;
};

}  // namespace hashphase::benchmarks
