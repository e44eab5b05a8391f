// SPDX-License-Identifier: Zlib
#pragma once

// What tests ask of an experiment's findings.

#include <demos/accuracy/experiment.hpp>

#include <gtest/gtest.h>

#include <set>

namespace hashphase::demos {

/// "claim (evidence)" of each check that does not hold.
[[nodiscard]] inline std::vector<std::string> brokenClaims(const Findings& findings) {
    std::vector<std::string> broken;
    for (const Check& check : findings.checks) {
        if (!check.holds) {
            broken.push_back(check.claim + " (" + check.evidence + ")");
        }
    }
    return broken;
}

/// Charts have rows, columns for all that they draw, and files of their own.
inline void expectChartsCanBeDrawn(const Findings& findings) {
    std::set<std::string> names;
    for (const Chart& chart : findings.charts) {
        SCOPED_TRACE(chart.name);
        EXPECT_TRUE(names.insert(chart.name).second);
        EXPECT_FALSE(chart.title.empty());
        EXPECT_FALSE(chart.settings.empty());
        EXPECT_FALSE(chart.data.rows.empty());
        for (const std::vector<Value>& row : chart.data.rows) {
            EXPECT_EQ(row.size(), chart.data.columns.size());
        }
        for (const std::string& column :
             {chart.x.column, chart.y.column, chart.series, chart.low, chart.high, chart.label,
              chart.shade.column, chart.theory}) {
            if (!column.empty()) {
                EXPECT_NO_THROW(static_cast<void>(chart.data.columnOf(column))) << column;
            }
        }
    }
}

inline void ignoreProgress(double /*share*/, std::string_view /*what*/) {}

}  // namespace hashphase::demos
