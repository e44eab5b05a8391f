// SPDX-License-Identifier: Zlib
#pragma once

// That experiments hold, and that they notice a method that is broken.

#include <demos/accuracy/experiment.hpp>
#include <tests/demos/units.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

namespace hashphase::demos {

inline void ignoreProgress(double /*share*/, std::string_view /*what*/) {}

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

/// Charts have rows and files of their own. (A chart of a column or mark that there is not throws.)
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
        expectUnits(chart.data);
    }
    for (const DataTable& table : findings.tables) {
        expectUnits(table);
    }
}

/// That all checks hold, and charts can be drawn. How many there are: checks, charts, choices, conclusions;
/// 0 is any number.
struct Whole {
    const char* id;
    Findings findings;
    std::array<std::size_t, 4> counts = {};
};

inline void expectHold(const std::vector<Whole>& all) {
    for (const auto& [id, findings, counts] : all) {
        SCOPED_TRACE(id);
        EXPECT_EQ(brokenClaims(findings), std::vector<std::string>{});
        expectChartsCanBeDrawn(findings);
        const std::array found{findings.checks.size(), findings.charts.size(),
                               findings.choices.size(), findings.conclusions.size()};
        for (std::size_t i = 0; i < found.size(); ++i) {
            EXPECT_TRUE(counts[i] == 0 ? found[i] > 0 : found[i] == counts[i])
                << i << ": " << found[i];
        }
    }
}

// --- Broken methods ------------------------------------------------------------------------------------

template <class Make>
[[nodiscard]] Method<Make> named(const std::vector<Method<Make>>& methods, std::string_view name) {
    return *std::ranges::find(methods, name, &Method<Make>::name);
}

/// Another one's work, changed.
template <class SomeMethod, class Change>
[[nodiscard]] SomeMethod with(const Change& change, SomeMethod method) {
    method.make = [change, make = method.make](const auto&... arguments) {
        return change(make(arguments...));
    };
    return method;
}

template <class SomeMethod>
[[nodiscard]] SomeMethod promising(const std::string& traits, SomeMethod method) {
    method.traits += ' ' + traits;
    return method;
}

struct Fault {
    const char* what;
    std::function<Findings()> find;
    std::vector<std::string> words;  // of the claims that break; no other one does
};

inline void expectNoticed(const std::vector<Fault>& faults) {
    for (const auto& [what, find, words] : faults) {
        SCOPED_TRACE(what);
        std::vector<std::string> broken = brokenClaims(find());
        for (const std::string& each : words) {
            EXPECT_GT(std::erase_if(broken,
                                    [&](const std::string& claim) {
                                        return claim.find(each) != std::string::npos;
                                    }),
                      0U)
                << each;
        }
        EXPECT_EQ(broken, std::vector<std::string>{});
    }
}

}  // namespace hashphase::demos
