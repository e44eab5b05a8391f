// SPDX-License-Identifier: Zlib
#pragma once

// Compares the pairs that a broadphase reports with the exact ones, frame by frame.

#include <demos/compare/reference_pairs.hpp>

#include <optional>

namespace hashphase::demos {

/// What one frame's comparison found.
struct FrameVerdict {
    std::size_t pairs = 0;       // reported
    std::size_t exactPairs = 0;  // overlapping and allowed
    std::size_t missing = 0;     // overlapping, but not reported
    std::size_t extra = 0;       // reported, but not overlapping; a second report of a pair counts
    std::size_t stale = 0;       // of the extra: overlapped once and have been reported ever since
    std::optional<PairKey> firstMissing;
    std::optional<PairKey> firstExtra;
};

/// Follows one broadphase through the frames.
class Verifier {
public:
    /// Both lists sorted. Cost: linear.
    FrameVerdict judge(std::span<const PairKey> reported, std::span<const PairKey> exact);

    /// What the last verdict counts, sorted; until the next one.
    [[nodiscard]] std::span<const PairKey> missing() const noexcept { return missing_; }
    [[nodiscard]] std::span<const PairKey> extra() const noexcept { return extra_; }

private:
    std::vector<PairKey> onceOverlapping_;  // reported since a frame in which they overlapped
    std::vector<PairKey> missing_;
    std::vector<PairKey> extra_;
    std::vector<PairKey> known_;
};

}  // namespace hashphase::demos
