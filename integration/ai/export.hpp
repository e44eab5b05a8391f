// SPDX-License-Identifier: Zlib
#pragma once

// Export macros of the library hashphase_ai: see broadphase/export.hpp.

#include <broadphase/export.hpp>

#ifdef hashphase_ai_EXPORTS
#define HASHPHASE_AI_EXPORT HASHPHASE_SYMBOL_EXPORT
#define HASHPHASE_AI_TEMPLATE_EXPORT HASHPHASE_SYMBOL_TEMPLATE_EXPORT
#else
#define HASHPHASE_AI_EXPORT HASHPHASE_SYMBOL_IMPORT
#define HASHPHASE_AI_TEMPLATE_EXPORT HASHPHASE_SYMBOL_IMPORT
#endif
