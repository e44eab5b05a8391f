// SPDX-License-Identifier: Zlib
#include <demos/replay/replay_track.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace hashphase::demos {
namespace {

void appendGroups(std::vector<std::uint8_t>& bytes, std::uint32_t number) {
    while (number > 127) {
        bytes.push_back(static_cast<std::uint8_t>(number | 128U));
        number >>= 7;
    }
    bytes.push_back(static_cast<std::uint8_t>(number));
}

constexpr double kSteps = 65535;

/// A part of the bounds' extent as a number of steps.
std::uint16_t stepsOf(double part, double extent) {
    const double steps = extent > 0 ? part / extent * kSteps : 0;
    return static_cast<std::uint16_t>(std::lround(std::clamp(steps, 0.0, kSteps)));
}

}  // namespace

ReplayTrack::ReplayTrack(const Aabb<float>& bounds, std::vector<std::uint32_t> objects,
                         std::size_t mostPairs)
    : isCut(objects.size(), 0),
      bounds_(bounds),
      objects_(std::move(objects)),
      mostPairs_(mostPairs),
      last_(objects_.size(), Sample{}) {}

void ReplayTrack::add(std::span<const Aabb<float>> boxes, std::span<const PairKey> pairs,
                      std::span<const PairKey> recordedPairs) {
    boxesBegin_ = boxStream.size();
    pairsBegin_ = pairStream.size();
    addBoxes(boxes, pairs);
    pairsInAll.push_back(pairs.size());
    pairCounts.push_back(recordedPairs.size());
    if (recordedPairs.size() > mostPairs_) {
        recordedPairs = {};
    }
    pairsListed.push_back(recordedPairs.size());
    addPairs(recordedPairs);
}

void ReplayTrack::removeLast() {
    boxStream.resize(boxesBegin_);
    pairStream.resize(pairsBegin_);
    for (auto* counts : {&pairsInAll, &pairCounts, &pairsListed}) {
        counts->pop_back();
    }
}

// --- Boxes ---------------------------------------------------------------------------------------

void ReplayTrack::addBoxes(std::span<const Aabb<float>> boxes, std::span<const PairKey> pairs) {
    overlaps_.assign(boxes.size(), 0);
    for (const PairKey pair : pairs) {
        ++overlaps_[firstOf(pair)];
        ++overlaps_[secondOf(pair)];
    }
    for (std::size_t i = 0; i < objects_.size(); ++i) {
        const Aabb<float>& box = boxes[objects_[i]];
        if (!bounds_.contains(box)) {
            isCut[i] = 1;
        }
        const Sample sample = sampleOf(box, overlaps_[objects_[i]]);
        Sample& last = last_[i];
        if (sample == last) {
            ++unchanged_;
            continue;
        }
        endRun();
        unsigned changed = 0;
        for (std::size_t k = 0; k < sample.size(); ++k) {
            changed |= sample[k] != last[k] ? 1U << k : 0U;
        }
        boxStream.push_back(static_cast<std::uint8_t>(changed));
        for (std::size_t k = 0; k < sample.size(); ++k) {
            if (sample[k] != last[k]) {
                const auto difference = static_cast<std::int16_t>(sample[k] - last[k]);
                const std::int32_t twice = 2 * difference;
                appendGroups(boxStream,
                             static_cast<std::uint32_t>(difference < 0 ? -twice - 1 : twice));
            }
        }
        last = sample;
    }
    endRun();
}

ReplayTrack::Sample ReplayTrack::sampleOf(const Aabb<float>& box, std::uint32_t overlaps) const {
    Sample sample{};
    if (!hasNan(box)) {
        for (int axis = 0; axis < 3; ++axis) {
            const double floor = bounds_.min()[axis];
            const double ceiling = bounds_.max()[axis];
            const double low = std::clamp(double{box.min()[axis]}, floor, ceiling);
            const double high = std::clamp(double{box.max()[axis]}, floor, ceiling);
            const auto k = static_cast<std::size_t>(axis);
            sample[k] = stepsOf((low + high) / 2 - floor, ceiling - floor);
            sample[k + 3] = stepsOf(high - low, ceiling - floor);
        }
    }
    sample[6] = static_cast<std::uint16_t>(std::min(overlaps, 65535U));
    return sample;
}

void ReplayTrack::endRun() {
    if (unchanged_ > 0) {
        boxStream.push_back(0);
        appendGroups(boxStream, unchanged_ - 1);
        unchanged_ = 0;
    }
}

// --- Pairs ---------------------------------------------------------------------------------------

void ReplayTrack::addPairs(std::span<const PairKey> pairs) {
    // Of each that is gone, how many stay between it and the one before.
    std::vector<std::uint32_t> stayedBetween;
    std::uint32_t stayed = 0;
    for (const PairKey pair : listed_) {
        if (std::ranges::binary_search(pairs, pair)) {
            ++stayed;
        } else {
            stayedBetween.push_back(std::exchange(stayed, 0));
        }
    }
    appendGroups(pairStream, static_cast<std::uint32_t>(stayedBetween.size()));
    for (const std::uint32_t number : stayedBetween) {
        appendGroups(pairStream, number);
    }

    std::vector<PairKey> births;
    std::ranges::set_difference(pairs, listed_, std::back_inserter(births));
    appendGroups(pairStream, static_cast<std::uint32_t>(births.size()));
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    for (const PairKey pair : births) {
        const std::uint32_t from = firstOf(pair) == a ? b : firstOf(pair);
        appendGroups(pairStream, firstOf(pair) - a);
        appendGroups(pairStream, secondOf(pair) - from);
        a = firstOf(pair);
        b = secondOf(pair);
    }
    listed_.assign(pairs.begin(), pairs.end());
}

}  // namespace hashphase::demos
