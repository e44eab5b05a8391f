// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/console/program.hpp>

namespace hashphase::demos {

/// `hashphase paper`.
[[nodiscard]] Subcommand paperCommand();

}  // namespace hashphase::demos
