// SPDX-License-Identifier: Zlib
#include <demos/try/preload/symbol.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include <dlfcn.h>
#include <link.h>

namespace hashphase::tryout {

namespace {

// Paths of all that is loaded; empty for the program.
std::vector<std::string> loadedObjects() {
    std::vector<std::string> paths;
    const auto add = [](dl_phdr_info* object, std::size_t /*size*/, void* into) {
        static_cast<std::vector<std::string>*>(into)->emplace_back(object->dlpi_name);
        return 0;
    };
    dl_iterate_phdr(add, &paths);
    return paths;
}

// What the object defines, or one that it was loaded with.
void* findIn(const std::string& path, const char* mangledName) {
    void* object = dlopen(path.empty() ? nullptr : path.c_str(), RTLD_LAZY | RTLD_NOLOAD);
    void* function = object != nullptr ? dlsym(object, mangledName) : nullptr;
    if (object != nullptr) {
        dlclose(object);  // is counted, and stays
    }
    return function;
}

std::string_view nameOf(std::string_view path) {
    return path.substr(path.rfind('/') + 1);
}

// Libraries that a plugin has brought along are not in the order of all.
void* findInPlugins(const char* mangledName) {
    for (const std::string& path : loadedObjects()) {
        void* function =
            nameOf(path).starts_with("libBullet") ? findIn(path, mangledName) : nullptr;
        if (function != nullptr) {
            return function;
        }
    }
    return nullptr;
}

const char* pathOf(const void* function) {
    Dl_info place{};
    return dladdr(function, &place) != 0 && place.dli_fname != nullptr ? place.dli_fname : "";
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
    const std::string ownPath = pathOf(reinterpret_cast<const void*>(&refuseOtherBullets));
    std::vector<std::string> bullets;  // in the order they were loaded
    for (const std::string& object : loadedObjects()) {
        const void* constructor =
            findIn(object, "_ZN16btDbvtBroadphaseC1EP22btOverlappingPairCache");
        const std::string path = constructor != nullptr ? pathOf(constructor) : ownPath;
        if (path != ownPath && std::ranges::find(bullets, path) == bullets.end()) {
            bullets.push_back(path);
        }
    }
    if (bullets.size() > 1) {
        std::string paths;
        for (const std::string& path : bullets) {
            paths += (paths.empty() ? "" : " and ") + path;
        }
        std::fprintf(
            stderr,
            "hashphase try: the program and hashphase use two Bullets, those of %s; is the "
            "precision right, and is none of them linked statically?\n",
            paths.c_str());
        std::abort();
    }
}

}  // namespace hashphase::tryout
