// SPDX-License-Identifier: Zlib
#include <demos/try/preload/symbol.hpp>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include <dlfcn.h>
#include <link.h>

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

void refuseOtherBullets() {
    struct Found {
        int count = 0;
        std::string names;
    } found;
    const auto look = [](dl_phdr_info* object, std::size_t /*size*/, void* into) {
        const std::string_view path = object->dlpi_name;
        const std::string_view name = path.substr(path.rfind('/') + 1);
        if (name.starts_with("libBulletCollision")) {
            auto& all = *static_cast<Found*>(into);
            all.names += std::string(all.count++ > 0 ? " and " : "") + std::string(name);
        }
        return 0;
    };
    dl_iterate_phdr(look, &found);
    if (found.count > 1) {
        std::fprintf(stderr,
                     "hashphase try: the program and hashphase use two Bullets, %s; is the "
                     "precision right?\n",
                     found.names.c_str());
        std::abort();
    }
}

}  // namespace hashphase::tryout
