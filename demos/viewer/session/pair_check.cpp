// SPDX-License-Identifier: Zlib
#include <demos/viewer/session/pair_check.hpp>

#include <algorithm>
#include <iterator>

namespace hashphase::demos {

void PairCheck::look(const Stage& stage) {
    stage.listBoxes(boxes_, filters_);
    stage.listPairs(listed_);
    findExactPairs(ReferenceMethod::kSweep, boxes_, filters_, exact_);
    missing_.clear();
    extra_.clear();
    std::set_difference(exact_.begin(), exact_.end(), listed_.begin(), listed_.end(),
                        std::back_inserter(missing_));
    std::set_difference(listed_.begin(), listed_.end(), exact_.begin(), exact_.end(),
                        std::back_inserter(extra_));
}

}  // namespace hashphase::demos
