// SPDX-License-Identifier: Zlib
#pragma once

// What a broadphase did in a hard case, and how it is told.

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

struct CaseOutcome {
    OutcomeKind kind = OutcomeKind::nothing;
    std::uint64_t compared = 0;  // right answers, each of which was looked for
    std::uint64_t missing = 0;   // of these
    std::uint64_t extra = 0;     // answers beyond them

    /// What it cost, as a multiple of what the case compares it with.
    std::optional<double> costRatio;

    /// What else is to be told, in sentences.
    std::string note;

    /// Of what did not end: the time that it had [s].
    double seconds = 0;
};

/// In a word or two: "exact", "-3 +12", "costly 12x", "> 2 s", "crashes"; "-" for nothing.
[[nodiscard]] std::string outcomeText(const CaseOutcome& outcome);

/// The kind's name: "exact", "hangs".
[[nodiscard]] std::string_view nameOf(OutcomeKind kind);

/// Adds up what one broadphase does in the parts of a case.
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

    [[nodiscard]] CaseOutcome outcome() const;

private:
    CaseOutcome sum_;
    std::vector<std::string> broken_;
    bool isCostly_ = false;
};

template <class Item>
void CaseTally::compare(std::span<const Item> reported, std::span<const Item> exact) {
    std::size_t r = 0;
    std::size_t e = 0;
    std::size_t common = 0;
    while (r < reported.size() && e < exact.size()) {
        if (reported[r] < exact[e]) {
            ++r;
        } else if (exact[e] < reported[r]) {
            ++e;
        } else {
            ++common;
            ++r;
            ++e;
        }
    }
    sum_.compared += exact.size();
    sum_.missing += exact.size() - common;
    sum_.extra += reported.size() - common;
}

}  // namespace hashphase::demos
