// SPDX-License-Identifier: Zlib
#pragma once

// The hard cases of `hashphase stability` as tests, each of its own name.

#include <demos/stability/hard_case.hpp>

#include <gtest/gtest.h>

#include <cctype>
#include <ostream>
#include <string>

namespace hashphase::demos {

// For GoogleTest.
inline void PrintTo(const HardCase& hardCase, std::ostream* out) {
    *out << hardCase.id << ' ' << hardCase.name;
}

}  // namespace hashphase::demos

namespace hashphase::test {

/// The subject that the run makes, at first the grid alone, is as the case requires on small inputs.
template <class Scalar>
void expectHolds(const demos::HardCase& hardCase, demos::CaseRun<Scalar> run = {}) {
    run.isQuick = true;
    hardCase.in<Scalar>()(run);
    const demos::CaseOutcome outcome = run.outcome();
    EXPECT_TRUE(holds(outcome)) << hardCase.id << " requires: " << hardCase.required << ".\n"
                                << outcome.note << '\n'
                                << outcome.missing << " of " << outcome.compared
                                << " answers are missing, " << outcome.extra << " too many; cost "
                                << outcome.costRatio.value_or(0) << "x. " << run.firstDifference();
}

/// "H16_a_ray_through_3_4e7_cells": GoogleTest takes letters, digits and underscores only.
inline std::string nameOfCase(const testing::TestParamInfo<demos::HardCase>& info) {
    std::string name = std::string(info.param.id) + '_';
    for (const char* letter = info.param.name; *letter != '\0'; ++letter) {
        if (std::isalnum(static_cast<unsigned char>(*letter)) != 0) {
            name += *letter;
        } else if (name.back() != '_') {
            name += '_';
        }
    }
    return name;
}

}  // namespace hashphase::test
