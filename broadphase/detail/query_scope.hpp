// SPDX-License-Identifier: Zlib
#pragma once

namespace hashphase::detail {

/// Lives while a grid calls somebody back on this thread, so that it can tell a call from within.
/// Costs two writes to memory of the thread's own.
class QueryScope {
public:
    /// Whether who is called back may change the grid.
    enum class Changes : bool { forbidden, allowed };

    QueryScope(const void* grid, Changes changes) noexcept
        : grid_(grid), outer_(innermost_), changes_(changes) {
        innermost_ = this;
    }
    ~QueryScope() { innermost_ = outer_; }
    QueryScope(const QueryScope&) = delete;
    QueryScope& operator=(const QueryScope&) = delete;

    /// Whether this thread is within a call of the grid's.
    [[nodiscard]] static bool isWithin(const void* grid) noexcept {
        return any(grid, [](const QueryScope&) { return true; });
    }
    /// Whether it is within one that takes no changes.
    [[nodiscard]] static bool forbidsChanges(const void* grid) noexcept {
        return any(grid, [](const QueryScope& s) { return s.changes_ == Changes::forbidden; });
    }

private:
    template <class Predicate>
    [[nodiscard]] static bool any(const void* grid, const Predicate& predicate) noexcept {
        for (const QueryScope* scope = innermost_; scope != nullptr; scope = scope->outer_) {
            if (scope->grid_ == grid && predicate(*scope)) {
                return true;
            }
        }
        return false;
    }

    static inline constinit thread_local const QueryScope* innermost_ = nullptr;

    const void* grid_;
    const QueryScope* outer_;
    Changes changes_;
};

}  // namespace hashphase::detail
