// SPDX-License-Identifier: Zlib
#include <demos/viewer/stage/phases.hpp>

#include <functional>
#include <iterator>

namespace hashphase::demos {

void PhaseHistory::add(std::span<const PhaseTime> times) {
    knowsBeginning_ = knowsBeginning_ && count_ < kFrames;
    for (Row& row : rows_) {
        row.isPresent = false;
        row.frames.push_back(0);
        row.frames.erase(row.frames.begin(), row.frames.end() - static_cast<std::ptrdiff_t>(
                                                                    std::min(count_ + 1, kFrames)));
    }
    count_ = std::min(count_ + 1, kFrames);
    for (const PhaseTime& time : times) {
        auto row = std::ranges::find(rows_, time.name, &Row::name);
        if (row == rows_.end()) {
            row = rows_.insert(rows_.end(), Row{time.name, std::deque<float>(count_), true});
        }
        row->isPresent = true;
        row->frames.back() = static_cast<float>(time.milliseconds);
    }
    std::erase_if(rows_, [](const Row& row) {
        return !row.isPresent && std::ranges::count(row.frames, 0) == std::ssize(row.frames);
    });
}

// The smallest time that so many percent of the frames do not exceed.
double PhaseHistory::atRank(const std::deque<float>& frames, std::size_t percent) const {
    if (frames.empty()) {
        return 0;
    }
    std::vector<float> told(frames.begin() + static_cast<std::ptrdiff_t>(firstTold()),
                            frames.end());
    const std::size_t rank = (told.size() * percent + 99) / 100;  // from 1, rounded up
    const auto place = told.begin() + static_cast<std::ptrdiff_t>(rank - 1);
    std::nth_element(told.begin(), place, told.end());
    return double{*place};
}

std::deque<float> PhaseHistory::totals() const {
    std::deque<float> totals(count_);
    for (const Row& row : rows_) {
        std::ranges::transform(totals, row.frames, totals.begin(), std::plus());
    }
    return totals;
}

std::vector<PhaseLine> phaseLines(const PhaseHistory& history, const PhaseHistory* before) {
    std::vector<PhaseLine> lines;
    for (const PhaseHistory::Row& row : history.rows()) {
        lines.push_back({row.name, history.median(row), history.p95(row), history.worst(row)});
    }
    if (before != nullptr) {
        for (const PhaseHistory::Row& row : before->rows()) {
            const auto known = std::ranges::find(lines, row.name, &PhaseLine::name);
            PhaseLine& line =
                known != lines.end() ? *known : lines.emplace_back(PhaseLine{.name = row.name});
            line.before = before->median(row);
        }
    }
    PhaseLine& together = lines.emplace_back(PhaseLine{.name = "total"});
    if (history.toldCount() > 0) {
        together.median = history.medianTotal();
        together.p95 = history.p95Total();
        together.worst = history.worstTotal();
    }
    if (before != nullptr) {
        together.before = before->medianTotal();
    }
    return lines;
}

}  // namespace hashphase::demos
