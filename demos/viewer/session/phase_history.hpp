// SPDX-License-Identifier: Zlib
#pragma once

// How long each phase has taken in the last frames, for a table and a stacked graph.

#include <demos/viewer/stage/phase_clock.hpp>

#include <cstddef>
#include <deque>
#include <span>
#include <string_view>
#include <vector>

namespace hashphase::demos {

class PhaseHistory {
public:
    static constexpr std::size_t kFrames = 240;

    struct Row {
        std::string_view name;
        double smoothed = 0;       // lately, for who looks on [ms]
        std::deque<float> frames;  // the oldest first; 0 in frames without the phase [ms]
        bool isPresent = false;    // in the last frame
    };

    /// Phases of a frame. Phases that have not been there for as long as the history reaches are gone.
    void add(std::span<const PhaseTime> times);

    /// In the order in which they first came.
    [[nodiscard]] std::span<const Row> rows() const noexcept { return rows_; }

    /// Frames that are known, at most kFrames.
    [[nodiscard]] std::size_t frameCount() const noexcept { return count_; }

    /// Known frames that times are told of: all but the first of the scene, which fills tables and caches, unless
    /// there is no other.
    [[nodiscard]] std::size_t toldCount() const noexcept { return count_ - firstTold(); }

    /// Of those, the time that half of them do not exceed, and the one that one in twenty does [ms].
    [[nodiscard]] double median(const Row& row) const { return atRank(row.frames, 50); }
    [[nodiscard]] double p95(const Row& row) const { return atRank(row.frames, 95); }

    /// All phases together [ms].
    [[nodiscard]] double smoothedTotal() const;
    [[nodiscard]] double medianTotal() const { return atRank(totals(), 50); }
    [[nodiscard]] double p95Total() const { return atRank(totals(), 95); }

private:
    [[nodiscard]] std::size_t firstTold() const noexcept {
        return knowsBeginning_ && count_ > 1 ? 1 : 0;
    }
    [[nodiscard]] double atRank(const std::deque<float>& frames, std::size_t percent) const;
    [[nodiscard]] std::deque<float> totals() const;

    std::vector<Row> rows_;
    bool knowsBeginning_ = true;  // the scene's first frame is still known, or to come
    std::size_t count_ = 0;
};

}  // namespace hashphase::demos
