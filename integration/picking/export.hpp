// SPDX-License-Identifier: Zlib
#pragma once

// Export macros of the library hashphase_picking: see broadphase/export.hpp.

#include <broadphase/export.hpp>

#ifdef hashphase_picking_EXPORTS
#define HASHPHASE_PICKING_EXPORT HASHPHASE_SYMBOL_EXPORT
#else
#define HASHPHASE_PICKING_EXPORT HASHPHASE_SYMBOL_IMPORT
#endif
