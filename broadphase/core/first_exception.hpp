// SPDX-License-Identifier: Zlib
#pragma once

// For threads that let no exception pass.

#include <broadphase/export.hpp>
#include <broadphase/parallel_for.hpp>

#include <atomic>
#include <cstddef>
#include <exception>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::detail {

class HASHPHASE_BROADPHASE_EXPORT FirstException {
public:
    /// Calls body(begin, end), and keeps what it throws, unless something is kept. Any thread may call it.
    void run(LoopBody body, std::size_t begin, std::size_t end) noexcept;

    /// When all threads have ended: throws what is kept.
    void rethrow() const;

private:
    std::atomic<bool> isKept_{false};
    std::exception_ptr exception_;
};

}  // namespace hashphase::detail

#include <broadphase/core/restore_macros.hpp>
