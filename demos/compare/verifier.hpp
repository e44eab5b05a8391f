// SPDX-License-Identifier: Zlib
#pragma once

// Compares the pairs that a broadphase reports with the exact ones, frame by frame.

#include <demos/compare/reference_pairs.hpp>

namespace hashphase::demos {

/// What one frame's comparison found.
struct PairVerdict {
    std::vector<PairKey> missing;  // overlapping and allowed, but not reported; sorted
    std::vector<PairKey> extra;    // reported, but not overlapping, or a second time; sorted
    std::size_t stale = 0;  // of the extra: overlapped once and have been reported ever since
};

/// Follows one broadphase through the frames.
class Verifier {
public:
    /// Both lists sorted. What it returns lasts until the next call. Cost: linear.
    const PairVerdict& judge(std::span<const PairKey> reported, std::span<const PairKey> exact);

private:
    PairVerdict verdict_;
    std::vector<PairKey> onceOverlapping_;  // reported since a frame in which they overlapped
    std::vector<PairKey> known_;
};

}  // namespace hashphase::demos
