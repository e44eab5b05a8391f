// SPDX-License-Identifier: Zlib
#define HASHPHASE_CULLING_LOOP cullByLoop

#include <tests/benchmarks/culling_loop.inl>
