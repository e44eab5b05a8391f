// SPDX-License-Identifier: Zlib
#pragma once

// Keeps the two precisions of Bullet apart. Everything that names a Bullet type is declared in
//
//     namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE { ... }
//
// so that its symbols say which precision it was compiled for. A program compiled for one precision
// does not link with the library of the other, where Bullet itself would link and go wrong.
// BT_USE_DOUBLE_PRECISION decides, as it does for Bullet; it has to be set for the whole program.

#ifdef BT_USE_DOUBLE_PRECISION
#define HASHPHASE_BULLET_NAMESPACE f64
#else
#define HASHPHASE_BULLET_NAMESPACE f32
#endif
