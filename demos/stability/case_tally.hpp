// SPDX-License-Identifier: Zlib
#pragma once

// What a subject did in a hard case, added up while the case runs.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {

enum class OutcomeKind : std::uint8_t {
    nothing,  // it offers nothing for the question
    exact,    // every answer, none too many, at no more than the cost allowed
    extra,    // every answer, and some too many
    costly,   // every answer, but at more than the cost allowed
    refuses,  // says that it cannot, and goes on
    wrong,    // answers are missing, or something else is not as required
    hangs,    // did not end within its time
    crashes,
};

struct CaseNumbers {
    OutcomeKind kind = OutcomeKind::nothing;
    std::uint64_t compared = 0;  // right answers, each of which was looked for
    std::uint64_t missing = 0;   // of these
    std::uint64_t extra = 0;     // answers beyond them

    /// What it cost, as a multiple of what the case compares it with.
    std::optional<double> costRatio;
};

struct CaseOutcome : CaseNumbers {
    /// What else is to be told, in sentences.
    std::string note;

    /// Of what did not end: the time that it had [s].
    double seconds = 0;
};

class CaseTally {
public:
    /// Both sorted. What is reported twice is once too many.
    template <class Item>
    void compare(std::span<const Item> reported, std::span<const Item> exact);
    template <class Item>
    void compare(const std::vector<Item>& reported, const std::vector<Item>& exact) {
        compare(std::span(reported), std::span(exact));
    }

    /// What must be so beside the answers; `what` is told when it is not: "the box was reported".
    void expect(bool holds, std::string_view what);

    /// A cost as a multiple of another one, and what it may be at most; the worst is kept.
    void addCost(double ratio, double bound);

    /// Appends a sentence.
    void note(std::string_view sentence);

    /// Adds what another one found, but for its notes; `where` tells what was not as required from what was
    /// not so here: " of the grid alone".
    void add(const CaseTally& other, std::string_view where);

    /// OutcomeKind::nothing where nothing was compared, expected or measured.
    [[nodiscard]] CaseOutcome outcome() const;

    /// The first answer that was missing or too many: "0-7 is missing"; empty when there is none.
    [[nodiscard]] const std::string& firstDifference() const noexcept { return difference_; }

private:
    void noteDifference(std::uint64_t item, bool isPair, const char* what);

    CaseOutcome sum_;
    std::vector<std::string> broken_;
    std::string difference_;
    bool isAsked_ = false;
    bool isCostly_ = false;
};

template <class Item>
void CaseTally::compare(std::span<const Item> reported, std::span<const Item> exact) {
    const auto differs = [this](const Item& item, const char* what) {
        if (difference_.empty()) {
            noteDifference(static_cast<std::uint64_t>(item), sizeof(Item) == 8, what);
        }
    };
    std::size_t r = 0;
    std::size_t e = 0;
    std::size_t common = 0;
    while (r < reported.size() || e < exact.size()) {
        if (e == exact.size() || (r < reported.size() && reported[r] < exact[e])) {
            differs(reported[r++], " is too many");
        } else if (r == reported.size() || exact[e] < reported[r]) {
            differs(exact[e++], " is missing");
        } else {
            ++common;
            ++r;
            ++e;
        }
    }
    isAsked_ = true;
    sum_.compared += exact.size();
    sum_.missing += exact.size() - common;
    sum_.extra += reported.size() - common;
}

}  // namespace hashphase::demos
