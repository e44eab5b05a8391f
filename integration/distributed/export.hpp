// SPDX-License-Identifier: Zlib
#pragma once

// Export macros of the library hashphase_distributed: see broadphase/export.hpp.

#include <broadphase/export.hpp>

#ifdef hashphase_distributed_EXPORTS
#define HASHPHASE_DISTRIBUTED_EXPORT HASHPHASE_SYMBOL_EXPORT
#define HASHPHASE_DISTRIBUTED_TEMPLATE_EXPORT HASHPHASE_SYMBOL_TEMPLATE_EXPORT
#else
#define HASHPHASE_DISTRIBUTED_EXPORT HASHPHASE_SYMBOL_IMPORT
#define HASHPHASE_DISTRIBUTED_TEMPLATE_EXPORT HASHPHASE_SYMBOL_IMPORT
#endif
