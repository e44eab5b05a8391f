// SPDX-License-Identifier: Zlib

// `hashphase wander`, a program of its own, so that `hashphase` needs no graphics: hashphase-wander.
// You should see 30,000 spheres roam hills, in the colours that they choose by their neighbours'.

#include <demos/viewer/show/wander.hpp>

#include <iostream>
#include <string>
#include <vector>

#include <unistd.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

int main(int argc, char** argv) {
    using namespace hashphase::demos;
#ifdef __GLIBC__
    // Mesa's software renderer frees a frame's memory at the top of the heap. Handed back to the kernel and
    // faulted in again, it would take a third of the main thread's time.
    mallopt(M_TRIM_THRESHOLD, 256 << 20);
#endif
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    Console console{std::cout, std::cerr, isatty(STDERR_FILENO) != 0, "hashphase wander"};
    for (const std::string& argument : arguments) {
        console.commandLine += " " + argument;
    }
    return runSingleCommand(arguments, wanderCommand(), console);
}
