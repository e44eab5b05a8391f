// SPDX-License-Identifier: Zlib
#include <broadphase/core/first_exception.hpp>

namespace hashphase::detail {

void FirstException::run(LoopBody body, std::size_t begin, std::size_t end) noexcept {
    try {
        body(begin, end);
    } catch (...) {
        if (!isKept_.exchange(true)) {
            exception_ = std::current_exception();
        }
    }
}

void FirstException::rethrow() const {
    if (exception_ != nullptr) {
        std::rethrow_exception(exception_);
    }
}

}  // namespace hashphase::detail
