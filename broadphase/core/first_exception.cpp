// SPDX-License-Identifier: Zlib
#include <broadphase/core/first_exception.hpp>

#include <broadphase/core/caught.hpp>

#include <utility>

namespace hashphase::detail {

void FirstException::run(LoopBody body, std::size_t begin, std::size_t end) noexcept {
    std::exception_ptr thrown = exceptionOf([&] { body(begin, end); });
    if (thrown != nullptr && !isKept_.exchange(true)) {
        exception_ = std::move(thrown);
    }
}

void FirstException::rethrow() const {
    if (exception_ != nullptr) {
        std::rethrow_exception(exception_);
    }
}

}  // namespace hashphase::detail
