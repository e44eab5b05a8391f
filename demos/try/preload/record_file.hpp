// SPDX-License-Identifier: Zlib
#pragma once

// The record that this process was asked for, mapped when the library is loaded: the program may change its
// folder, its root or its rights later.

#include <demos/try/record.hpp>

namespace hashphase::tryout {

/// Whether there should be one.
[[nodiscard]] bool wasRecordAskedFor() noexcept;

/// nullptr where none was asked for, or it cannot be had.
[[nodiscard]] Record* mappedRecord() noexcept;

}  // namespace hashphase::tryout
