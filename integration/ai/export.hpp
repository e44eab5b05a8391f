// SPDX-License-Identifier: Zlib
#pragma once

// What the shared library hashphase_ai offers: see broadphase/export.hpp.

#include <broadphase/export.hpp>

#ifdef hashphase_ai_EXPORTS
#define HASHPHASE_AI_EXPORT HASHPHASE_SYMBOL_EXPORT
#define HASHPHASE_AI_TEMPLATE_EXPORT HASHPHASE_SYMBOL_TEMPLATE_EXPORT
#else
#define HASHPHASE_AI_EXPORT HASHPHASE_SYMBOL_IMPORT
#define HASHPHASE_AI_TEMPLATE_EXPORT HASHPHASE_SYMBOL_IMPORT
#endif
