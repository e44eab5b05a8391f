// SPDX-License-Identifier: Zlib
#pragma once

// How long the phases of a frame take, which follow each other without a gap, and what the last frames took, for a
// table and a stacked graph.

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <deque>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace hashphase::demos {

struct PhaseTime {
    std::string_view name;
    double milliseconds = 0;
};

class PhaseClock {
public:
    /// Begins a frame, of which nothing is known yet.
    void begin() {
        times_.clear();
        last_ = Clock::now();
    }

    /// What has passed since begin() or the last end() belongs to this phase, whose name lives as long as
    /// the program. One that ends twice in a frame has the sum.
    void end(std::string_view phase) {
        const double milliseconds = skip();
        add(phase, milliseconds);
    }

    /// What has passed since then belongs to nobody, or to those who are told by add(). Returns it [ms].
    double skip() {
        const Clock::time_point before = std::exchange(last_, Clock::now());
        return std::chrono::duration<double, std::milli>(last_ - before).count();
    }

    /// Adds what somebody else has measured.
    void add(std::string_view phase, double milliseconds) {
        const auto known = std::ranges::find(times_, phase, &PhaseTime::name);
        if (known != times_.end()) {
            known->milliseconds += milliseconds;
        } else {
            times_.push_back({phase, milliseconds});
        }
    }

    /// In the order in which they first ended.
    [[nodiscard]] std::span<const PhaseTime> times() const noexcept { return times_; }

private:
    using Clock = std::chrono::steady_clock;

    std::vector<PhaseTime> times_;
    Clock::time_point last_ = Clock::now();
};

class PhaseHistory {
public:
    static constexpr std::size_t kFrames = 240;

    struct Row {
        std::string_view name;
        std::deque<float> frames;  // the oldest first; 0 in frames without the phase [ms]
        bool isPresent = false;    // in the last frame
    };

    /// Phases of a frame. Phases that have not been there for as long as the history reaches are gone.
    void add(std::span<const PhaseTime> times);

    /// In the order in which they first came.
    [[nodiscard]] std::span<const Row> rows() const noexcept { return rows_; }

    /// Frames that are known, at most kFrames.
    [[nodiscard]] std::size_t frameCount() const noexcept { return count_; }

    /// Known frames that times are told of: all but the first one, which fills tables and caches, unless there is
    /// no other.
    [[nodiscard]] std::size_t toldCount() const noexcept { return count_ - firstTold(); }

    /// Of those, the time that half of them do not exceed, the one that one in twenty does, and the longest [ms].
    [[nodiscard]] double median(const Row& row) const { return atRank(row.frames, 50); }
    [[nodiscard]] double p95(const Row& row) const { return atRank(row.frames, 95); }
    [[nodiscard]] double worst(const Row& row) const { return atRank(row.frames, 100); }

    /// All phases together [ms].
    [[nodiscard]] double medianTotal() const { return atRank(totals(), 50); }
    [[nodiscard]] double p95Total() const { return atRank(totals(), 95); }
    [[nodiscard]] double worstTotal() const { return atRank(totals(), 100); }

private:
    [[nodiscard]] std::size_t firstTold() const noexcept {
        return knowsBeginning_ && count_ > 1 ? 1 : 0;
    }
    [[nodiscard]] double atRank(const std::deque<float>& frames, std::size_t percent) const;
    [[nodiscard]] std::deque<float> totals() const;

    std::vector<Row> rows_;
    bool knowsBeginning_ = true;  // the first frame is still known, or to come
    std::size_t count_ = 0;
};

/// The times of a phase [ms]; empty where there are none.
struct PhaseLine {
    std::string_view name;
    std::optional<double> median = {};
    std::optional<double> p95 = {};
    std::optional<double> worst = {};
    std::optional<double> before = {};  // median of another history
};

/// The rows of a history, in their order; then phases that only the other one has, where it is not null; then
/// "total".
[[nodiscard]] std::vector<PhaseLine> phaseLines(const PhaseHistory& history,
                                                const PhaseHistory* before);

}  // namespace hashphase::demos
