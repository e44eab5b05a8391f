// SPDX-License-Identifier: Zlib
#pragma once

// That numbers have units: in the title of their column, in brackets, or as what is counted.

#include <demos/experiment/findings.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

namespace hashphase::demos {

[[nodiscard]] inline bool hasUnit(const std::string& title) {
    constexpr std::array<std::string_view, 20> kUnits{
        "[",          "pairs",    "contacts", "objects",       "boxes",  "cells",  "frames",
        "agents",     "hits",     "tests",    "steps",         "bodies", "scenes", "neighbours",
        "iterations", "triangle", "bytes",    "times as fast", "rays",   "sticks"};
    return title == "frame" || title == "step" ||
           std::ranges::any_of(kUnits, [&](std::string_view unit) {
               return title.find(unit) != std::string::npos;
           });
}

inline void expectUnits(const DataTable& table) {
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const bool hasNumber = std::ranges::any_of(table.rows, [i](const std::vector<Value>& row) {
            return std::holds_alternative<double>(row[i]);
        });
        EXPECT_TRUE(!hasNumber || hasUnit(titleOf(table.columns[i])))
            << "no unit: '" << titleOf(table.columns[i]) << "'";
    }
}

inline void expectUnits(const PageSection& section) {
    SCOPED_TRACE(section.heading);
    std::ranges::for_each(section.tables, [](const DataTable& each) { expectUnits(each); });
    for (const Chart& chart : section.charts) {
        SCOPED_TRACE(chart.name);
        expectUnits(chart.data);
    }
}

}  // namespace hashphase::demos
