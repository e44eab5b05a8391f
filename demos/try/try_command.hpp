// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/console/program.hpp>

namespace hashphase::demos {

/// `hashphase try`: see try.hpp.
[[nodiscard]] Subcommand tryCommand();

}  // namespace hashphase::demos
