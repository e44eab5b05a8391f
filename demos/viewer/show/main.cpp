// SPDX-License-Identifier: Zlib

// `hashphase wander`, a program of its own, so that `hashphase` needs no graphics: hashphase-wander.
// You should see 30,000 spheres roam hills, in the colours that they choose by their neighbours'.

#include <demos/viewer/show/wander.hpp>

#if HASHPHASE_HAS_MALLOPT
#include <malloc.h>
#endif

int main(int argc, char** argv) {
    using namespace hashphase::demos;
#if HASHPHASE_HAS_MALLOPT
    // Mesa's software renderer frees a frame's memory at the top of the heap. Handed back to the kernel and
    // faulted in again, it would take a third of the main thread's time.
    mallopt(M_TRIM_THRESHOLD, 256 << 20);
#endif
    return runMain(argc, argv, wanderCommand());
}
