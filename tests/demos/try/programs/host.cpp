// SPDX-License-Identifier: Zlib

// host PLUGIN NAME: runs a program of a plugin.

#include <cstdio>

#include <dlfcn.h>

int main(int argc, char** argv) {
    void* plugin = argc == 3 ? dlopen(argv[1], RTLD_NOW) : nullptr;
    void* run = plugin != nullptr ? dlsym(plugin, "runProgram") : nullptr;
    if (run == nullptr) {
        std::puts("no plugin");
        return 5;
    }
    return reinterpret_cast<int (*)(const char*)>(run)(argv[2]);
}
