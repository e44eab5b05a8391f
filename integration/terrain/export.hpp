// SPDX-License-Identifier: Zlib
#pragma once

// Export macros of the library hashphase_terrain: see broadphase/export.hpp.

#include <broadphase/export.hpp>

#ifdef hashphase_terrain_EXPORTS
#define HASHPHASE_TERRAIN_EXPORT HASHPHASE_SYMBOL_EXPORT
#define HASHPHASE_TERRAIN_TEMPLATE_EXPORT HASHPHASE_SYMBOL_TEMPLATE_EXPORT
#else
#define HASHPHASE_TERRAIN_EXPORT HASHPHASE_SYMBOL_IMPORT
#define HASHPHASE_TERRAIN_TEMPLATE_EXPORT HASHPHASE_SYMBOL_IMPORT
#endif
