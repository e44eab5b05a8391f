// SPDX-License-Identifier: Zlib
#include <demos/compare/verifier.hpp>

#include <algorithm>
#include <iterator>

namespace hashphase::demos {

FrameVerdict Verifier::judge(std::span<const PairKey> reported, std::span<const PairKey> exact) {
    FrameVerdict verdict;
    verdict.pairs = reported.size();
    verdict.exactPairs = exact.size();

    difference_.clear();
    std::set_difference(exact.begin(), exact.end(), reported.begin(), reported.end(),
                        std::back_inserter(difference_));
    verdict.missing = difference_.size();
    if (!difference_.empty()) {
        verdict.firstMissing = difference_.front();
    }

    difference_.clear();
    std::set_difference(reported.begin(), reported.end(), exact.begin(), exact.end(),
                        std::back_inserter(difference_));
    verdict.extra = difference_.size();
    if (!difference_.empty()) {
        verdict.firstExtra = difference_.front();
    }

    known_.clear();
    std::set_intersection(difference_.begin(), difference_.end(), onceOverlapping_.begin(),
                          onceOverlapping_.end(), std::back_inserter(known_));
    verdict.stale = known_.size();

    // Reported now, and overlapping now or known from before.
    difference_.clear();
    std::set_union(exact.begin(), exact.end(), onceOverlapping_.begin(), onceOverlapping_.end(),
                   std::back_inserter(difference_));
    onceOverlapping_.clear();
    std::set_intersection(reported.begin(), reported.end(), difference_.begin(), difference_.end(),
                          std::back_inserter(onceOverlapping_));
    return verdict;
}

}  // namespace hashphase::demos
