// SPDX-License-Identifier: Zlib
#pragma once

// An experiment about what accuracy costs in time: a question, the methods that answer it, the error
// and the time of each.
//
// Truth     comes from brute force, in rational or much higher precision where rounding matters;
//           never from a method under test.
// Missed    and false answers are different columns: the former are wrong, the latter cost time.
// Times     are medians of at least 60 different frames, methods in turn within each.

#include <demos/experiment/findings.hpp>

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
