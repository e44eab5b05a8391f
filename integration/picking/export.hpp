// SPDX-License-Identifier: Zlib
#pragma once

// What the shared library hashphase_picking offers: see broadphase/export.hpp.

#include <broadphase/export.hpp>

#ifdef hashphase_picking_EXPORTS
#define HASHPHASE_PICKING_EXPORT HASHPHASE_SYMBOL_EXPORT
#else
#define HASHPHASE_PICKING_EXPORT HASHPHASE_SYMBOL_IMPORT
#endif
