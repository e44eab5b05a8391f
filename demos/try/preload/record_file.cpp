// SPDX-License-Identifier: Zlib
#include <demos/try/preload/record_file.hpp>

#include <cstdlib>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace hashphase::tryout {
namespace {

Record* mapRecord() noexcept {
    const char* path = std::getenv(kRecordVariable);
    const int file = path != nullptr ? open(path, O_RDWR | O_CLOEXEC) : -1;
    if (file < 0) {
        return nullptr;
    }
    struct stat status {};
    void* bytes = MAP_FAILED;
    if (fstat(file, &status) == 0 && status.st_size == static_cast<off_t>(sizeof(Record))) {
        bytes = mmap(nullptr, sizeof(Record), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    }
    close(file);
    auto* mapped = static_cast<Record*>(bytes);
    if (bytes == MAP_FAILED || mapped->format != Record::kFormat) {
        return nullptr;
    }
    mapped->isLoaded = 1;
    return mapped;
}

[[gnu::constructor]] void mapEarly() {
    static_cast<void>(mappedRecord());
}

// Whoever has started the process may not tell. Forks of the recorded process have its record, and another
// number.
[[gnu::destructor]] void noteEnd() {
    if (Record* into = mappedRecord(); into != nullptr && into->process.load() == getpid()) {
        into->hasEnded = 1;
    }
}

[[noreturn]] void endWithoutDestructors(int status) noexcept {
    noteEnd();
    for (;;) {
        syscall(SYS_exit_group, status);
    }
}

}  // namespace

bool wasRecordAskedFor() noexcept {
    static const bool wasAskedFor = std::getenv(kRecordVariable) != nullptr;
    return wasAskedFor;
}

Record* mappedRecord() noexcept {
    static Record* const mapped = mapRecord();
    return mapped;
}

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
