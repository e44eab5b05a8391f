// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/try/step_summary.hpp>

#include <iosfwd>

namespace hashphase::demos {

/// Whether a run with ours ended in a way in which none of Bullet's did.
[[nodiscard]] bool isEndOfOurs(const Trial& trial);

/// How the program has ended comes last, where that is not with status 0.
void printTrial(const Trial& trial, std::ostream& out);
void writeTrialJson(const Trial& trial, std::ostream& out);

}  // namespace hashphase::demos
