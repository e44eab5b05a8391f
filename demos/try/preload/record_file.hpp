// SPDX-License-Identifier: Zlib
#pragma once

// The record that this process was asked for, mapped when the library is loaded: the program may change its
// folder, its root or its rights later.

#include <demos/try/record.hpp>

namespace hashphase::tryout {

/// Whether there should be one.
[[nodiscard]] bool wasRecordAskedFor() noexcept;

/// nullptr where none was asked for, or it cannot be had. Record::hasEnded is set at the end of the recorded
/// process: by exit(), by the end of main(), by _exit() or _Exit() and, once it is watched, by quick_exit(). A
/// signal, or another program in its place, leave it.
[[nodiscard]] Record* mappedRecord() noexcept;

void watchQuickExit() noexcept;

}  // namespace hashphase::tryout
