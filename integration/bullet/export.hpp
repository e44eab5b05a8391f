// SPDX-License-Identifier: Zlib
#pragma once

// Export macros of the libraries hashphase_bullet and hashphase_bullet_float64: see broadphase/export.hpp. If these
// two are static (because Bullet is static), but hashphase's other libraries are shared, CMake and pkg-config set
// HASHPHASE_BULLET_IS_STATIC to 1.

#include <broadphase/export.hpp>

#ifndef HASHPHASE_BULLET_IS_STATIC
#define HASHPHASE_BULLET_IS_STATIC 0
#endif

#if HASHPHASE_BULLET_IS_STATIC
#define HASHPHASE_BULLET_EXPORT
#elif defined(hashphase_bullet_EXPORTS) || defined(hashphase_bullet_float64_EXPORTS)
#define HASHPHASE_BULLET_EXPORT HASHPHASE_SYMBOL_EXPORT
#else
#define HASHPHASE_BULLET_EXPORT HASHPHASE_SYMBOL_IMPORT
#endif
