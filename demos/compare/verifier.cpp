// SPDX-License-Identifier: Zlib
#include <demos/compare/verifier.hpp>

#include <algorithm>
#include <iterator>

namespace hashphase::demos {

FrameVerdict Verifier::judge(std::span<const PairKey> reported, std::span<const PairKey> exact) {
    FrameVerdict verdict;
    verdict.pairs = reported.size();
    verdict.exactPairs = exact.size();

    missing_.clear();
    std::set_difference(exact.begin(), exact.end(), reported.begin(), reported.end(),
                        std::back_inserter(missing_));
    verdict.missing = missing_.size();
    if (!missing_.empty()) {
        verdict.firstMissing = missing_.front();
    }

    extra_.clear();
    std::set_difference(reported.begin(), reported.end(), exact.begin(), exact.end(),
                        std::back_inserter(extra_));
    verdict.extra = extra_.size();
    if (!extra_.empty()) {
        verdict.firstExtra = extra_.front();
    }

    known_.clear();
    std::set_intersection(extra_.begin(), extra_.end(), onceOverlapping_.begin(),
                          onceOverlapping_.end(), std::back_inserter(known_));
    verdict.stale = known_.size();

    // Reported now, and overlapping now or known from before.
    known_.clear();
    std::set_union(exact.begin(), exact.end(), onceOverlapping_.begin(), onceOverlapping_.end(),
                   std::back_inserter(known_));
    onceOverlapping_.clear();
    std::set_intersection(reported.begin(), reported.end(), known_.begin(), known_.end(),
                          std::back_inserter(onceOverlapping_));
    return verdict;
}

}  // namespace hashphase::demos
