// SPDX-License-Identifier: Zlib
#pragma once

// A program whose vectors and strings have other layouts than those of the libraries does not link: whatever
// includes a grid asks for a name that only libraries with the same standard library define.

#include <broadphase/core/compiler.hpp>
#include <broadphase/export.hpp>

namespace hashphase {

/// Defined by libraries that were compiled with that standard library, and that mode of it.
extern HASHPHASE_BROADPHASE_EXPORT const char HASHPHASE_STANDARD_LIBRARY;

namespace detail {

HASHPHASE_ASK_LINKER_FOR(HASHPHASE_STANDARD_LIBRARY)
[[HASHPHASE_KEPT]] static const char* const kStandardLibrary = &HASHPHASE_STANDARD_LIBRARY;

}  // namespace detail
}  // namespace hashphase
