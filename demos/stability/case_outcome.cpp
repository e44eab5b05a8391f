// SPDX-License-Identifier: Zlib
#include <demos/stability/case_outcome.hpp>

#include <demos/console/format.hpp>

#include <algorithm>
#include <array>

namespace hashphase::demos {
namespace {

// The longest number that a narrow column shows in full is 99,999.
std::string shortCount(std::uint64_t count) {
    if (count < 100'000) {
        return withThousands(count);
    }
    return count < 10'000'000 ? withThousands(count / 1000) + "k"
                              : withThousands(count / 1'000'000) + "M";
}

std::string ratioText(double ratio) {
    return fixed(ratio, ratio < 9.95 ? 1 : 0) + "x";
}

std::string secondsText(double seconds) {
    return fixed(seconds, seconds < 1 ? 2 : 0) + " s";
}

std::string countsText(const CaseOutcome& outcome) {
    std::string text;
    if (outcome.missing > 0) {
        text = "-" + shortCount(outcome.missing);
    }
    if (outcome.extra > 0) {
        text += (text.empty() ? "+" : " +") + shortCount(outcome.extra);
    }
    return text;
}

}  // namespace

std::string_view nameOf(OutcomeKind kind) {
    static constexpr std::array<std::string_view, 8> kNames{"nothing", "exact", "extra", "costly",
                                                            "refuses", "wrong", "hangs", "crashes"};
    return kNames.at(static_cast<std::size_t>(kind));
}

std::string outcomeText(const CaseOutcome& outcome) {
    switch (outcome.kind) {
        case OutcomeKind::nothing:
            return "-";
        case OutcomeKind::exact:
            return outcome.costRatio ? "exact " + ratioText(*outcome.costRatio) : "exact";
        case OutcomeKind::costly:
            return "costly " + ratioText(outcome.costRatio.value_or(0));
        case OutcomeKind::extra:
            return countsText(outcome);
        case OutcomeKind::wrong:
            return outcome.missing > 0 ? countsText(outcome) : "wrong";
        case OutcomeKind::hangs:
            return "> " + secondsText(outcome.seconds);
        default:
            return std::string(nameOf(outcome.kind));
    }
}

void CaseTally::expect(bool holds, std::string_view what) {
    ++sum_.compared;
    if (!holds && std::find(broken_.begin(), broken_.end(), what) == broken_.end()) {
        broken_.emplace_back(what);
    }
}

void CaseTally::addCost(double ratio, double bound) {
    sum_.costRatio = std::max(sum_.costRatio.value_or(0), ratio);
    isCostly_ |= !(ratio <= bound);
}

void CaseTally::note(std::string_view sentence) {
    if (!sum_.note.empty()) {
        sum_.note += ' ';
    }
    sum_.note += sentence;
}

CaseOutcome CaseTally::outcome() const {
    CaseOutcome outcome = sum_;
    for (const std::string& what : broken_) {
        outcome.note += (outcome.note.empty() ? "Not so: " : " Not so: ") + what + ".";
    }
    if (outcome.missing > 0 || !broken_.empty()) {
        outcome.kind = OutcomeKind::wrong;
    } else if (isCostly_) {
        outcome.kind = OutcomeKind::costly;
    } else {
        outcome.kind = outcome.extra > 0 ? OutcomeKind::extra : OutcomeKind::exact;
    }
    return outcome;
}

}  // namespace hashphase::demos
