// SPDX-License-Identifier: Zlib
#include <demos/try/preload/symbol.hpp>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include <dlfcn.h>
#include <link.h>

namespace hashphase::tryout {

namespace {

// Calls found(path, name) for each of Bullet's libraries that is loaded.
template <class Found>
void forEachBullet(Found found) {
    const auto look = [](dl_phdr_info* object, std::size_t /*size*/, void* into) {
        const std::string_view path = object->dlpi_name;
        const std::string_view name = path.substr(path.rfind('/') + 1);
        if (name.starts_with("libBullet")) {
            (*static_cast<Found*>(into))(object->dlpi_name, name);
        }
        return 0;
    };
    dl_iterate_phdr(look, &found);
}

// Libraries that a plugin has brought along are not in the order of all.
void* findInPlugins(const char* mangledName) {
    std::vector<std::string> paths;
    forEachBullet([&](const char* path, std::string_view /*name*/) { paths.emplace_back(path); });
    for (const std::string& path : paths) {
        void* library = dlopen(path.c_str(), RTLD_LAZY | RTLD_NOLOAD);
        void* function = library != nullptr ? dlsym(library, mangledName) : nullptr;
        if (function != nullptr) {
            return function;
        }
    }
    return nullptr;
}

}  // namespace

void* findNext(const char* mangledName) {
    void* function = dlsym(RTLD_NEXT, mangledName);
    if (function == nullptr) {
        function = findInPlugins(mangledName);
    }
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
    int count = 0;
    std::string names;
    forEachBullet([&](const char* /*path*/, std::string_view name) {
        if (name.starts_with("libBulletCollision")) {
            names += (count++ > 0 ? " and " : "") + std::string(name);
        }
    });
    if (count > 1) {
        std::fprintf(stderr,
                     "hashphase try: the program and hashphase use two Bullets, %s; is the "
                     "precision right?\n",
                     names.c_str());
        std::abort();
    }
}

}  // namespace hashphase::tryout
