// SPDX-License-Identifier: Zlib
#pragma once

// Separates the two precisions of Bullet. Everything that uses a Bullet type is declared in
//
//     namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE { ... }
//
// so that symbols contain the precision. A program that mixes both precisions does not link. Without hashphase, such
// a program would link, and fail at run time. Define BT_USE_DOUBLE_PRECISION for the whole program if Bullet was
// built with it, otherwise nowhere.

#ifdef BT_USE_DOUBLE_PRECISION
#define HASHPHASE_BULLET_NAMESPACE f64
#else
#define HASHPHASE_BULLET_NAMESPACE f32
#endif
