// SPDX-License-Identifier: Zlib
#pragma once

// Export macros of the library hashphase_camera: see broadphase/export.hpp.

#include <broadphase/export.hpp>

#ifdef hashphase_camera_EXPORTS
#define HASHPHASE_CAMERA_EXPORT HASHPHASE_SYMBOL_EXPORT
#define HASHPHASE_CAMERA_TEMPLATE_EXPORT HASHPHASE_SYMBOL_TEMPLATE_EXPORT
#else
#define HASHPHASE_CAMERA_EXPORT HASHPHASE_SYMBOL_IMPORT
#define HASHPHASE_CAMERA_TEMPLATE_EXPORT HASHPHASE_SYMBOL_IMPORT
#endif
