// SPDX-License-Identifier: Zlib
#pragma once

// Exceptions that headers throw. A header calls these, and says neither throw nor catch, so that it
// compiles with -fno-exceptions as well. In libraries that are compiled so, these hand the sentence to the
// assertion handler (broadphase/diagnostics.hpp), and abort.

#include <broadphase/export.hpp>

#include <string>

namespace hashphase::detail {

/// Throws std::length_error with the sentence.
[[noreturn]] HASHPHASE_BROADPHASE_EXPORT void raiseLengthError(const char* sentence);

/// Throws std::invalid_argument with the sentence.
[[noreturn]] HASHPHASE_BROADPHASE_EXPORT void raiseInvalidArgument(const std::string& sentence);

/// Throws std::out_of_range with the sentence.
[[noreturn]] HASHPHASE_BROADPHASE_EXPORT void raiseOutOfRange(const char* sentence);

}  // namespace hashphase::detail
