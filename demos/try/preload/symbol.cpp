// SPDX-License-Identifier: Zlib
#include <demos/try/preload/symbol.hpp>

#include <cstdio>
#include <cstdlib>

#include <dlfcn.h>

namespace hashphase::tryout {

void* findNext(const char* mangledName) {
    void* function = dlsym(RTLD_NEXT, mangledName);
    if (function == nullptr) {
        std::fprintf(stderr,
                     "hashphase try: this program's Bullet lacks %s, which that of hashphase has; "
                     "are they of the same version?\n",
                     mangledName);
        std::abort();
    }
    return function;
}

}  // namespace hashphase::tryout
