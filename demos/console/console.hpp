// SPDX-License-Identifier: Zlib
#pragma once

// Where commands write, and how they end.
//
// Exit codes  0 all well, 1 a check failed, 2 wrong usage or bad input.
// Output      results go to `out`; progress, warnings and errors to `err`.

#include <functional>
#include <iosfwd>
#include <string>

namespace hashphase::demos {

struct Page;

inline constexpr int kExitOk = 0;
inline constexpr int kExitCheckFailed = 1;
inline constexpr int kExitUsage = 2;

/// Where a command writes.
struct Console {
    std::ostream& out;
    std::ostream& err;
    bool errIsTerminal = false;
    std::string commandLine;  // as typed, for the record

    /// Takes the page of a report, whether or not it goes to a file; empty: nobody does.
    std::function<void(const Page&)> takePage = {};
};

/// Says what is wrong, and returns kExitUsage.
int refuse(Console& console, const std::string& sentence);

/// The version of hashphase that this program was built from.
[[nodiscard]] const char* programVersion() noexcept;

}  // namespace hashphase::demos
