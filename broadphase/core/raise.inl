// SPDX-License-Identifier: Zlib
#pragma once

// For sources of the libraries: nothing else of theirs says throw.

#include <broadphase/core/compiler.hpp>
#include <broadphase/diagnostics.hpp>

#include <cstdlib>

namespace hashphase::detail {

/// Throws the exception. Compiled without exceptions, hands its sentence to the assertion handler
/// (broadphase/diagnostics.hpp), which by default prints it, and aborts.
template <class Exception>
[[noreturn]] void raise(const Exception& exception) {
#if HASHPHASE_HAS_EXCEPTIONS
    throw exception;
#else
    reportBrokenAssert("throw", exception.what(), __FILE__, __LINE__);
    std::abort();
#endif
}

}  // namespace hashphase::detail
