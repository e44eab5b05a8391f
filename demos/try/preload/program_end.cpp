// SPDX-License-Identifier: Zlib

// Notes that the process that is recorded has ended by itself: whoever has started it may not tell.

#include <demos/try/preload/program_end.hpp>

#include <demos/try/preload/record_file.hpp>

#include <cstdlib>

#include <sys/syscall.h>
#include <unistd.h>

namespace hashphase::tryout {
namespace {

// Forks of the recorded process have its record, and another number.
void noteEnd() noexcept {
    if (Record* into = mappedRecord(); into != nullptr && into->process.load() == getpid()) {
        into->hasEnded = 1;
    }
}

[[gnu::destructor]] void noteExit() {
    noteEnd();
}

[[noreturn]] void endWithoutDestructors(int status) noexcept {
    noteEnd();
    for (;;) {
        syscall(SYS_exit_group, status);
    }
}

}  // namespace

void watchQuickExit() noexcept {
    static_cast<void>(std::at_quick_exit(&noteEnd));  // fails where there are too many
}

}  // namespace hashphase::tryout

// In place of those of the C library, which run nothing of ours.
extern "C" {

void _exit(int status) {
    hashphase::tryout::endWithoutDestructors(status);
}

void _Exit(int status) noexcept {
    hashphase::tryout::endWithoutDestructors(status);
}
}
