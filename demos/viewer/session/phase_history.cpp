// SPDX-License-Identifier: Zlib
#include <demos/viewer/session/phase_history.hpp>

#include <algorithm>

namespace hashphase::demos {
namespace {

constexpr double kWeight = 0.08;  // of a new frame in what is smoothed

double p95Of(std::vector<float>& sample) {
    if (sample.empty()) {
        return 0;
    }
    const auto place = sample.begin() + static_cast<std::ptrdiff_t>((sample.size() - 1) * 95 / 100);
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
    next_ = (next_ + 1) % kFrames;
    count_ = std::min(count_ + 1, kFrames);
    std::erase_if(rows_, [](const Row& row) {
        return !row.isPresent && std::all_of(row.frames.begin(), row.frames.end(),
                                             [](float frame) { return frame == 0; });
    });
}

double PhaseHistory::p95(const Row& row) const {
    std::vector<float> sample;
    for (std::size_t frame = 0; frame < count_; ++frame) {
        sample.push_back(at(row, frame));
    }
    return p95Of(sample);
}

double PhaseHistory::smoothedTotal() const {
    double sum = 0;
    for (const Row& row : rows_) {
        sum += row.isPresent ? row.smoothed : 0;
    }
    return sum;
}

double PhaseHistory::p95Total() const {
    std::vector<float> sample;
    for (std::size_t frame = 0; frame < count_; ++frame) {
        float sum = 0;
        for (const Row& row : rows_) {
            sum += at(row, frame);
        }
        sample.push_back(sum);
    }
    return p95Of(sample);
}

}  // namespace hashphase::demos
