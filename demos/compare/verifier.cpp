// SPDX-License-Identifier: Zlib
#include <demos/compare/verifier.hpp>

#include <algorithm>
#include <iterator>

namespace hashphase::demos {

const PairVerdict& Verifier::judge(std::span<const PairKey> reported,
                                   std::span<const PairKey> exact) {
    auto& [missing, extra, stale] = verdict_;
    missing.clear();
    std::set_difference(exact.begin(), exact.end(), reported.begin(), reported.end(),
                        std::back_inserter(missing));
    extra.clear();
    std::set_difference(reported.begin(), reported.end(), exact.begin(), exact.end(),
                        std::back_inserter(extra));
    known_.clear();
    std::set_intersection(extra.begin(), extra.end(), onceOverlapping_.begin(),
                          onceOverlapping_.end(), std::back_inserter(known_));
    stale = known_.size();

    // Reported now, and overlapping now or known from before.
    known_.clear();
    std::set_union(exact.begin(), exact.end(), onceOverlapping_.begin(), onceOverlapping_.end(),
                   std::back_inserter(known_));
    onceOverlapping_.clear();
    std::set_intersection(reported.begin(), reported.end(), known_.begin(), known_.end(),
                          std::back_inserter(onceOverlapping_));
    return verdict_;
}

}  // namespace hashphase::demos
