// SPDX-License-Identifier: Zlib
#include <demos/replay/replay_pairs.hpp>

#include <demos/replay/replay_bytes.hpp>

#include <algorithm>
#include <iterator>

namespace hashphase::demos {

void ReplayPairs::add(std::span<const PairKey> pairs) {
    counts_.push_back(pairs.size());
    if (pairs.size() > most_) {
        pairs = {};
    }
    listedCounts_.push_back(pairs.size());
    lastBegin_ = stream_.size();
    writeDeaths(pairs);
    births_.clear();
    std::set_difference(pairs.begin(), pairs.end(), listed_.begin(), listed_.end(),
                        std::back_inserter(births_));
    writeBirths();
    listed_.assign(pairs.begin(), pairs.end());
}

void ReplayPairs::removeLast() {
    stream_.resize(lastBegin_);
    counts_.pop_back();
    listedCounts_.pop_back();
}

void ReplayPairs::writeDeaths(std::span<const PairKey> pairs) {
    std::vector<std::uint32_t> stayedBetween;
    std::uint32_t stayed = 0;
    auto now = pairs.begin();
    for (const PairKey pair : listed_) {
        now = std::find_if(now, pairs.end(), [pair](PairKey each) { return each >= pair; });
        if (now != pairs.end() && *now == pair) {
            ++stayed;
        } else {
            stayedBetween.push_back(stayed);
            stayed = 0;
        }
    }
    appendGroups(stream_, static_cast<std::uint32_t>(stayedBetween.size()));
    for (const std::uint32_t number : stayedBetween) {
        appendGroups(stream_, number);
    }
}

void ReplayPairs::writeBirths() {
    appendGroups(stream_, static_cast<std::uint32_t>(births_.size()));
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    for (const PairKey pair : births_) {
        const std::uint32_t from = firstOf(pair) == a ? b : firstOf(pair);
        appendGroups(stream_, firstOf(pair) - a);
        appendGroups(stream_, secondOf(pair) - from);
        a = firstOf(pair);
        b = secondOf(pair);
    }
}

}  // namespace hashphase::demos
