// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/console/program.hpp>

namespace hashphase::demos {

/// `hashphase try`: runs a program of somebody's twice, with Bullet's broadphase and with ours, and says what
/// that makes of its steps; or once with both, to verify the pairs.
/// Exit codes: kExitCheckFailed when pairs of ours were wrong, when nothing was verified or a verified run ended
/// by a crash, when the program ended in another way with ours than with Bullet's, or a later run of it made no
/// broadphase; kExitUsage when the first did not; 128 and a signal's number when that has ended the trial.
[[nodiscard]] Subcommand tryCommand();

}  // namespace hashphase::demos
