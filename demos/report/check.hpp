// SPDX-License-Identifier: Zlib
#pragma once

#include <string>

namespace hashphase::demos {

/// What must be so, and whether it is.
struct Check {
    std::string claim;  // "Swept modes miss nothing"
    bool holds = false;
    std::string evidence;  // the numbers: "0 of 1,000,000"
};

}  // namespace hashphase::demos
