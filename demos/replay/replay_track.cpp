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

ReplayTrack::ReplayTrack(const Aabb<float>& bounds, std::vector<std::uint32_t> objects)
    : bounds_(bounds),
      objects_(std::move(objects)),
      last_(objects_.size(), Sample{}),
      isCut_(objects_.size(), 0) {}

void ReplayTrack::add(std::span<const Aabb<float>> boxes, std::span<const PairKey> pairs) {
    overlaps_.assign(boxes.size(), 0);
    for (const PairKey pair : pairs) {
        ++overlaps_[firstOf(pair)];
        ++overlaps_[secondOf(pair)];
    }
    lastBegin_ = stream_.size();
    for (std::size_t i = 0; i < objects_.size(); ++i) {
        const Aabb<float>& box = boxes[objects_[i]];
        if (!bounds_.contains(box)) {
            isCut_[i] = 1;
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
        stream_.push_back(static_cast<std::uint8_t>(changed));
        for (std::size_t k = 0; k < sample.size(); ++k) {
            if (sample[k] != last[k]) {
                const auto difference = static_cast<std::int16_t>(sample[k] - last[k]);
                const std::int32_t twice = 2 * difference;
                appendGroups(stream_,
                             static_cast<std::uint32_t>(difference < 0 ? -twice - 1 : twice));
            }
        }
        last = sample;
    }
    endRun();
}

void ReplayTrack::removeLast() {
    stream_.resize(lastBegin_);
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
        stream_.push_back(0);
        appendGroups(stream_, unchanged_ - 1);
        unchanged_ = 0;
    }
}

// --- Pairs ---------------------------------------------------------------------------------------

void ReplayPairs::add(std::span<const PairKey> pairs) {
    counts_.push_back(pairs.size());
    if (pairs.size() > most_) {
        pairs = {};
    }
    listedCounts_.push_back(pairs.size());
    lastBegin_ = stream_.size();
    writeDeaths(pairs);
    std::vector<PairKey> births;
    std::ranges::set_difference(pairs, listed_, std::back_inserter(births));
    appendGroups(stream_, static_cast<std::uint32_t>(births.size()));
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    for (const PairKey pair : births) {
        const std::uint32_t from = firstOf(pair) == a ? b : firstOf(pair);
        appendGroups(stream_, firstOf(pair) - a);
        appendGroups(stream_, secondOf(pair) - from);
        a = firstOf(pair);
        b = secondOf(pair);
    }
    listed_.assign(pairs.begin(), pairs.end());
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
            stayedBetween.push_back(std::exchange(stayed, 0));
        }
    }
    appendGroups(stream_, static_cast<std::uint32_t>(stayedBetween.size()));
    for (const std::uint32_t number : stayedBetween) {
        appendGroups(stream_, number);
    }
}

void ReplayPairs::removeLast() {
    stream_.resize(lastBegin_);
    counts_.pop_back();
    listedCounts_.pop_back();
}

}  // namespace hashphase::demos
