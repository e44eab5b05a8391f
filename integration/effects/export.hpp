// SPDX-License-Identifier: Zlib
#pragma once

// Export macros of the library hashphase_effects: see broadphase/export.hpp.

#include <broadphase/export.hpp>

#ifdef hashphase_effects_EXPORTS
#define HASHPHASE_EFFECTS_EXPORT HASHPHASE_SYMBOL_EXPORT
#define HASHPHASE_EFFECTS_TEMPLATE_EXPORT HASHPHASE_SYMBOL_TEMPLATE_EXPORT
#else
#define HASHPHASE_EFFECTS_EXPORT HASHPHASE_SYMBOL_IMPORT
#define HASHPHASE_EFFECTS_TEMPLATE_EXPORT HASHPHASE_SYMBOL_IMPORT
#endif
