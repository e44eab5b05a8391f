// SPDX-License-Identifier: Zlib
#include <demos/viewer/session/phase_history.hpp>

#include <algorithm>

namespace hashphase::demos {
namespace {

constexpr double kWeight = 0.08;  // of a new frame in what is smoothed

// The smallest time that so many percent of the sample do not exceed.
double timeAtRank(std::vector<float> sample, std::size_t percent) {
    if (sample.empty()) {
        return 0;
    }
    const std::size_t rank = (sample.size() * percent + 99) / 100;  // from 1, rounded up
    const auto place = sample.begin() + static_cast<std::ptrdiff_t>(rank - 1);
    std::nth_element(sample.begin(), place, sample.end());
    return double{*place};
}

}  // namespace

void PhaseHistory::clear() {
    *this = {};
}

void PhaseHistory::add(std::span<const PhaseTime> times) {
    for (Row& row : rows_) {
        row.isPresent = false;
        row.frames[next_] = 0;
    }
    for (const PhaseTime& time : times) {
        auto row = std::find_if(rows_.begin(), rows_.end(),
                                [&](const Row& known) { return known.name == time.name; });
        if (row == rows_.end()) {
            row = rows_.insert(rows_.end(), Row{.name = time.name, .smoothed = time.milliseconds});
        }
        row->isPresent = true;
        row->frames[next_] = static_cast<float>(time.milliseconds);
        row->smoothed += kWeight * (time.milliseconds - row->smoothed);
    }
    knowsBeginning_ = knowsBeginning_ && count_ < kFrames;
    next_ = (next_ + 1) % kFrames;
    count_ = std::min(count_ + 1, kFrames);
    std::erase_if(rows_, [](const Row& row) {
        return !row.isPresent && std::all_of(row.frames.begin(), row.frames.end(),
                                             [](float frame) { return frame == 0; });
    });
}

std::vector<float> PhaseHistory::timesOf(const Row& row) const {
    std::vector<float> times;
    for (std::size_t frame = firstTold(); frame < count_; ++frame) {
        times.push_back(at(row, frame));
    }
    return times;
}

std::vector<float> PhaseHistory::totals() const {
    std::vector<float> totals;
    for (std::size_t frame = firstTold(); frame < count_; ++frame) {
        float sum = 0;
        for (const Row& row : rows_) {
            sum += at(row, frame);
        }
        totals.push_back(sum);
    }
    return totals;
}

double PhaseHistory::median(const Row& row) const {
    return timeAtRank(timesOf(row), 50);
}

double PhaseHistory::p95(const Row& row) const {
    return timeAtRank(timesOf(row), 95);
}

double PhaseHistory::smoothedTotal() const {
    double sum = 0;
    for (const Row& row : rows_) {
        sum += row.isPresent ? row.smoothed : 0;
    }
    return sum;
}

double PhaseHistory::medianTotal() const {
    return timeAtRank(totals(), 50);
}

double PhaseHistory::p95Total() const {
    return timeAtRank(totals(), 95);
}

}  // namespace hashphase::demos
