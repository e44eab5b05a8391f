// SPDX-License-Identifier: Zlib
#pragma once

// An experiment about what accuracy costs in time: a question, the methods that answer it, the error
// and the time of each.
//
// Truth     comes from brute force, in rational or much higher precision where rounding matters;
//           never from a method under test.
// Missed    and false answers are different columns: the former are wrong, the latter cost time.
// Times     are medians of at least 60 different frames, methods in turn within each.

#include <demos/report/chart.hpp>
#include <demos/report/check.hpp>
#include <demos/report/data_table.hpp>

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {

/// How much an experiment may measure.
struct Effort {
    bool isQuick = false;
    std::uint64_t seed = 1;

    /// One or the other.
    template <class Number>
    [[nodiscard]] Number quickOrFull(Number quick, Number full) const {
        return isQuick ? quick : full;
    }
};

/// A method as a choice that somebody has: what it costs, what it gets wrong.
struct Choice {
    std::string
        task;  // what is bought; choices of the same task compete: "Fast movers, 30,000 ..."
    std::string method;       // "Sweep::line"
    double milliseconds = 0;  // a frame
    double error = 0;         // 0 is exact; comparable within a task
    std::string result;       // the error in words: "misses 3.1 % of contacts"
    bool isOurs = true;       // else of the paper or of Bullet, for comparison
};

/// What an experiment found.
struct Findings {
    std::vector<std::string> settings;  // sentences on scenes, sizes, truth
    std::vector<Chart> charts;
    std::vector<DataTable> tables;  // what is read better than drawn; titles of columns are shown
    std::vector<Check> checks;
    std::vector<Choice> choices;
    std::vector<std::string>
        conclusions;  // sentences that the numbers above show, bad news included
};

/// Takes the share that is done, 0 to 1, and what is being done.
using TellProgress = std::function<void(double, std::string_view)>;

struct Experiment {
    std::string_view id;  // "P1"
    std::string_view title;
    std::string_view question;
    double quickSeconds;  // about how long it takes, for the progress bar
    double fullSeconds;
    std::function<Findings(const Effort&, const TellProgress&)> run;
};

}  // namespace hashphase::demos
