// SPDX-License-Identifier: Zlib
#pragma once

// Keeps the two precisions of Bullet apart. Everything that names a Bullet type is declared in
//
//     namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE { ... }
//
// so that its symbols name the precision. Mixing precisions is a link error; Bullet alone would link and go wrong.
// Set BT_USE_DOUBLE_PRECISION for the whole program, as for Bullet.

#ifdef BT_USE_DOUBLE_PRECISION
#define HASHPHASE_BULLET_NAMESPACE f64
#else
#define HASHPHASE_BULLET_NAMESPACE f32
#endif
