// SPDX-License-Identifier: Zlib
#pragma once

#include <string_view>

namespace hashphase::demos {

/// The style sheet of all pages.
[[nodiscard]] std::string_view pageStyle();

}  // namespace hashphase::demos
