// SPDX-License-Identifier: Zlib
#pragma once

#include <exception>
#include <utility>

namespace hashphase::detail {

/// Calls undo() where an exception leaves the scope; the exception passes on:
///
///     const OnFailure clearAll([&] { clear(); });
///
/// `undo` throws nothing. Compiled without exceptions it is never called.
template <class Undo>
class OnFailure {
public:
    explicit OnFailure(Undo undo) noexcept : undo_(std::move(undo)) {}
    ~OnFailure() {
        if (std::uncaught_exceptions() > exceptionsBefore_) {
            undo_();
        }
    }
    OnFailure(const OnFailure&) = delete;
    OnFailure& operator=(const OnFailure&) = delete;

private:
    Undo undo_;
    int exceptionsBefore_ = std::uncaught_exceptions();
};

}  // namespace hashphase::detail
