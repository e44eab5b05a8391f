// SPDX-License-Identifier: Zlib
#pragma once

// A hard case: an input on which plain code goes wrong, and what is required instead. Every outcome is
// found by running it; nothing is known beforehand.

#include <demos/compare/broadphase_kind.hpp>
#include <demos/stability/case_outcome.hpp>

#include <cstdint>

namespace hashphase::demos {

/// Who runs a case, and how much of it.
struct CaseContext {
    const BroadphaseKind& kind;
    bool isQuick = false;
    std::uint64_t seed = 1;

    template <class Number>
    [[nodiscard]] Number quickOrFull(Number quick, Number full) const {
        return isQuick ? quick : full;
    }
};

struct HardCase {
    const char* id;        // "H16"
    const char* name;      // a few words
    const char* input;     // exactly what is handed in
    const char* required;  // of a broadphase that holds

    /// Runs one broadphase through it, in a process of its own (isolation.hpp).
    CaseOutcome (*run)(const CaseContext& context);
};

/// Whether the outcome is as required.
[[nodiscard]] inline bool holds(const CaseOutcome& outcome) {
    return outcome.kind == OutcomeKind::exact;
}

}  // namespace hashphase::demos
