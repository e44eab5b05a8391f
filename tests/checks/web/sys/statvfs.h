// SPDX-License-Identifier: Zlib
#pragma once

// What the file system of the C++ library asks for, and Debian's C library for WebAssembly does not have:
// permissions and links, which are not there, and the room on a disk.

#include <sys/types.h>

#include <cerrno>

#define DT_SOCK 20

struct statvfs {
    unsigned long f_frsize, f_blocks, f_bfree, f_bavail;
};

inline int hashphaseNotThere() {
    errno = ENOSYS;
    return -1;
}
inline int statvfs(const char*, struct statvfs*) { return hashphaseNotThere(); }
inline int fchmod(int, mode_t) { return hashphaseNotThere(); }
inline int fchmodat(int, const char*, mode_t, int) { return hashphaseNotThere(); }
inline char* realpath(const char*, char*) {
    errno = ENOSYS;
    return nullptr;
}
