// SPDX-License-Identifier: Zlib

// The same programs in a library, for a host that links no Bullet and loads this as it runs.

#include "program.hpp"

extern "C" int runProgram(const char* name);

int runProgram(const char* name) {
    return programs::run(name);
}
