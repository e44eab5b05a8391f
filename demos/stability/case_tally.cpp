// SPDX-License-Identifier: Zlib
#include <demos/stability/case_tally.hpp>

#include <algorithm>

namespace hashphase::demos {

void CaseTally::expect(bool holds, std::string_view what) {
    isAsked_ = true;
    ++sum_.compared;
    if (!holds && std::find(broken_.begin(), broken_.end(), what) == broken_.end()) {
        broken_.emplace_back(what);
    }
}

void CaseTally::addCost(double ratio, double bound) {
    isAsked_ = true;
    sum_.costRatio = std::max(sum_.costRatio.value_or(0), ratio);
    isCostly_ |= !(ratio <= bound);
}

void CaseTally::note(std::string_view sentence) {
    if (!sum_.note.empty()) {
        sum_.note += ' ';
    }
    sum_.note += sentence;
}

void CaseTally::add(const CaseTally& other, std::string_view where) {
    isAsked_ |= other.isAsked_;
    isCostly_ |= other.isCostly_;
    sum_.compared += other.sum_.compared;
    sum_.missing += other.sum_.missing;
    sum_.extra += other.sum_.extra;
    if (other.sum_.costRatio) {
        sum_.costRatio = std::max(sum_.costRatio.value_or(0), *other.sum_.costRatio);
    }
    for (const std::string& what : other.broken_) {
        broken_.push_back(what + std::string(where));
    }
    difference_ = difference_.empty() ? other.difference_ : difference_;
}

CaseOutcome CaseTally::outcome() const {
    CaseOutcome outcome = sum_;
    for (const std::string& what : broken_) {
        outcome.note += (outcome.note.empty() ? "Not true: " : " Not true: ") + what + ".";
    }
    if (!isAsked_) {
        outcome.kind = OutcomeKind::nothing;
    } else if (outcome.missing > 0 || !broken_.empty()) {
        outcome.kind = OutcomeKind::wrong;
    } else if (isCostly_) {
        outcome.kind = OutcomeKind::costly;
    } else {
        outcome.kind = outcome.extra > 0 ? OutcomeKind::extra : OutcomeKind::exact;
    }
    return outcome;
}

void CaseTally::noteDifference(std::uint64_t item, bool isPair, const char* what) {
    difference_ =
        (isPair ? std::to_string(item >> 32) + '-' : "") + std::to_string(item & 0xffffffff) + what;
}

}  // namespace hashphase::demos
