// SPDX-License-Identifier: Zlib
#pragma once

// What the shared library hashphase_distributed offers: see broadphase/export.hpp.

#include <broadphase/export.hpp>

#ifdef hashphase_distributed_EXPORTS
#define HASHPHASE_DISTRIBUTED_EXPORT HASHPHASE_SYMBOL_EXPORT
#define HASHPHASE_DISTRIBUTED_TEMPLATE_EXPORT HASHPHASE_SYMBOL_TEMPLATE_EXPORT
#else
#define HASHPHASE_DISTRIBUTED_EXPORT HASHPHASE_SYMBOL_IMPORT
#define HASHPHASE_DISTRIBUTED_TEMPLATE_EXPORT HASHPHASE_SYMBOL_IMPORT
#endif
