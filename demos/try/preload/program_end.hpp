// SPDX-License-Identifier: Zlib
#pragma once

// Record::hasEnded is set at the end of the recorded process: by exit(), by the end of main(), by _exit() or
// _Exit() and, once it is watched, by quick_exit(). A signal, or another program in its place, leave it.

namespace hashphase::tryout {

void watchQuickExit() noexcept;

}  // namespace hashphase::tryout
