// SPDX-License-Identifier: Zlib
#include <broadphase/core/caught.hpp>

#include <broadphase/core/compiler.hpp>

#include <new>
#include <stdexcept>

namespace hashphase::detail {

#if HASHPHASE_HAS_EXCEPTIONS

std::exception_ptr exceptionOf(FunctionRef<void()> body) noexcept {
    try {
        body();
    } catch (...) {
        return std::current_exception();
    }
    return nullptr;
}

bool hasRoomFor(FunctionRef<void()> body) {
    try {
        body();
    } catch (const std::bad_alloc&) {
        return false;
    } catch (const std::length_error&) {
        return false;
    }
    return true;
}

#else

std::exception_ptr exceptionOf(FunctionRef<void()> body) noexcept {
    body();
    return nullptr;
}

bool hasRoomFor(FunctionRef<void()> body) {
    body();
    return true;
}

#endif

}  // namespace hashphase::detail
