// SPDX-License-Identifier: Zlib
#define HASHPHASE_CULLING_LOOP cullByWideLoop

#include <tests/benchmarks/culling_loop.inl>
