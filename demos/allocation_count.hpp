// SPDX-License-Identifier: Zlib
#pragma once

#include <cstddef>

namespace hashphase::demos {

/// How often the program has called `new`, on all threads.
[[nodiscard]] std::size_t allocationCount() noexcept;

}  // namespace hashphase::demos
