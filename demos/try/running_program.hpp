// SPDX-License-Identifier: Zlib
#pragma once

// A program that is tried, while it runs.

#include <demos/try/record.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace hashphase::demos {

/// The words, for a call of the system's; nullptr is the last one.
[[nodiscard]] std::vector<char*> pointersTo(std::vector<std::string>& words);

struct ProgramCall {
    std::string path;
    std::vector<std::string> words;      // argv, the name first
    std::vector<std::string> variables;  // its environment: "NAME=value"

    std::optional<std::uint32_t> stepLimit;  // ends the program after so many steps
    std::optional<double> secondLimit;       // or seconds
    std::function<void()> sayThatItWaits;    // for what was left behind, and has no broadphase
};

/// How a program ended.
struct RunEnd {
    // What the program did: "ended with status 0", "was ended by signal 11 (Segmentation fault)"; "was
    // stopped", by us, at a limit or because we were interrupted.
    std::string text = "ended with status 0";
    bool isCrash = false;  // by a signal that nobody here has sent
};

/// Runs the program, which fills `record`, to its end or to a limit. A signal that this process notes
/// (interruption.hpp) ends it, too: at first it is asked to, some seconds later no longer. Throws InputError when it
/// cannot be started.
[[nodiscard]] RunEnd runToTheEnd(ProgramCall call, const tryout::Record& record);

}  // namespace hashphase::demos
