// SPDX-License-Identifier: Zlib
#pragma once

// Exceptions that the libraries catch: nothing else of theirs says try and catch. Compiled without
// exceptions these functions only call body(). Clean-up that lets the exception pass: on_failure.hpp.

#include <broadphase/export.hpp>
#include <broadphase/function_ref.hpp>

#include <exception>

namespace hashphase::detail {

/// What body() throws; null when it throws nothing.
[[nodiscard]] HASHPHASE_BROADPHASE_EXPORT std::exception_ptr exceptionOf(
    FunctionRef<void()> body) noexcept;

/// Whether there is memory for all that body() does: false when it throws std::bad_alloc or
/// std::length_error. Passes on what else it throws.
[[nodiscard]] HASHPHASE_BROADPHASE_EXPORT bool hasRoomFor(FunctionRef<void()> body);

}  // namespace hashphase::detail
