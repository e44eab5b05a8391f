// SPDX-License-Identifier: Zlib
#pragma once

// What comes of a command line.

#include <demos/console/program.hpp>

#include <span>
#include <sstream>
#include <string>
#include <vector>

namespace hashphase::demos {

struct Typed {
    int exitCode = 0;
    std::string out;
    std::string err;
};

inline Typed typed(const std::vector<std::string>& arguments,
                   std::span<const Subcommand> subcommands) {
    std::ostringstream out;
    std::ostringstream err;
    const int exitCode = runProgram(arguments, subcommands, {out, err, false, "hashphase test"});
    return {exitCode, out.str(), err.str()};
}

}  // namespace hashphase::demos
