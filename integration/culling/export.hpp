// SPDX-License-Identifier: Zlib
#pragma once

// What the shared library hashphase_culling offers: see broadphase/export.hpp.

#include <broadphase/export.hpp>

#ifdef hashphase_culling_EXPORTS
#define HASHPHASE_CULLING_EXPORT HASHPHASE_SYMBOL_EXPORT
#define HASHPHASE_CULLING_TEMPLATE_EXPORT HASHPHASE_SYMBOL_TEMPLATE_EXPORT
#else
#define HASHPHASE_CULLING_EXPORT HASHPHASE_SYMBOL_IMPORT
#define HASHPHASE_CULLING_TEMPLATE_EXPORT HASHPHASE_SYMBOL_IMPORT
#endif
