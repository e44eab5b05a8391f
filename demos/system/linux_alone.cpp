// SPDX-License-Identifier: Zlib

// In place of a subcommand that works on Linux alone.

#include <cstdio>

int main() {
    std::fputs("hashphase: hashphase " HASHPHASE_SUBCOMMAND " is for Linux alone.\n", stderr);
    return 2;  // kExitUsage
}
