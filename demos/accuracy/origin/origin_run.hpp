// SPDX-License-Identifier: Zlib
#pragma once

// One scene at one distance from the origin, by all methods.

#include <demos/accuracy/origin/origin_methods.hpp>
#include <demos/report/statistics.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace hashphase::demos {

/// What a method answered, over all frames that were looked at.
struct OriginOutcome {
    std::uint64_t pairs = 0;  // that there are
    std::uint64_t missedPairs = 0;
    std::uint64_t extraPairs = 0;  // reported, but apart; or a second time
    std::uint64_t hits = 0;        // of rays on boxes, that there are
    std::uint64_t missedHits = 0;
    std::uint64_t falseHits = 0;
    Spread frameMs;  // to set all boxes and bring the pairs up to date

    // Of the pairs, or hits, that there are; false ones may be many times as many.
    [[nodiscard]] double missedPairPercent() const { return percent(missedPairs, pairs); }
    [[nodiscard]] double extraPairPercent() const { return percent(extraPairs, pairs); }
    [[nodiscard]] double missedHitPercent() const { return percent(missedHits, hits); }
    [[nodiscard]] double falseHitPercent() const { return percent(falseHits, hits); }

private:
    static double percent(std::uint64_t part, std::uint64_t whole) {
        return whole == 0 ? 0 : 100 * static_cast<double>(part) / static_cast<double>(whole);
    }
};

struct OriginOutcomes {
    std::vector<OriginOutcome> methods;
    Spread atOriginMs;  // the first method with the scene at the origin, measured in between
};

/// Moves the scene for 60 frames or more, all methods in turn in each, and compares every tenth with
/// exact arithmetic.
[[nodiscard]] OriginOutcomes runAt(const BodyPlacement& place, OriginScene scene,
                                   std::span<const OriginMethod> methods);

}  // namespace hashphase::demos
