// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/export.hpp>

namespace hashphase::detail {

/// Must not be broken by who is called back.
inline constexpr const char* kMustNotChange =
    "A grid or broadphase was changed from within a filter, visitEach() or the query of a convex "
    "volume. Change it after that returns.";

/// Lives while a grid, or a client of one, calls somebody back on this thread, so that it can tell a
/// call from within. Costs two writes to memory of the thread's own.
class QueryScope {
public:
    /// Whether who is called back may change the owner.
    enum class Changes : bool { forbidden, allowed };

    explicit QueryScope(const void* owner, Changes changes = Changes::forbidden) noexcept
        : owner_(owner), outer_(innermost()), changes_(changes) {
        innermost() = this;
    }
    ~QueryScope() { innermost() = outer_; }
    QueryScope(const QueryScope&) = delete;
    QueryScope& operator=(const QueryScope&) = delete;

    /// Whether this thread is within a call of the owner's.
    [[nodiscard]] static bool isWithin(const void* owner) noexcept {
        return any(owner, [](const QueryScope&) { return true; });
    }
    /// Whether it is within one that takes no changes.
    [[nodiscard]] static bool forbidsChanges(const void* owner) noexcept {
        return any(owner, [](const QueryScope& s) { return s.changes_ == Changes::forbidden; });
    }

private:
    template <class Predicate>
    [[nodiscard]] static bool any(const void* owner, const Predicate& predicate) noexcept {
        for (const QueryScope* scope = innermost(); scope != nullptr; scope = scope->outer_) {
            if (scope->owner_ == owner && predicate(*scope)) {
                return true;
            }
        }
        return false;
    }

#if HASHPHASE_SHARES_VARIABLES
    HASHPHASE_ONE_FOR_ALL static inline constinit thread_local const QueryScope* innermost_ =
        nullptr;
    [[nodiscard]] static const QueryScope*& innermost() noexcept {
        return innermost_;
    }
#else
    [[nodiscard]] HASHPHASE_BROADPHASE_EXPORT static const QueryScope*& innermost() noexcept;
#endif

    const void* owner_;
    const QueryScope* outer_;
    Changes changes_;
};

}  // namespace hashphase::detail
