// SPDX-License-Identifier: Zlib
#pragma once

// Export macros of the library hashphase_culling: see broadphase/export.hpp.

#include <broadphase/export.hpp>

#ifdef hashphase_culling_EXPORTS
#define HASHPHASE_CULLING_EXPORT HASHPHASE_SYMBOL_EXPORT
#define HASHPHASE_CULLING_TEMPLATE_EXPORT HASHPHASE_SYMBOL_TEMPLATE_EXPORT
#else
#define HASHPHASE_CULLING_EXPORT HASHPHASE_SYMBOL_IMPORT
#define HASHPHASE_CULLING_TEMPLATE_EXPORT HASHPHASE_SYMBOL_IMPORT
#endif
