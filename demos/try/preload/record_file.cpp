// SPDX-License-Identifier: Zlib
#include <demos/try/preload/record_file.hpp>

#include <cstdlib>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
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
    if (bytes == MAP_FAILED) {
        return nullptr;
    }
    auto* mapped = static_cast<Record*>(bytes);
    if (mapped->format != Record::kFormat) {
        return nullptr;
    }
    mapped->isLoaded = 1;
    return mapped;
}

[[gnu::constructor]] void mapEarly() {
    static_cast<void>(mappedRecord());
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

}  // namespace hashphase::tryout
