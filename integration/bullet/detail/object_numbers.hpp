// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/core/flat_set.hpp>

#include <cstddef>
#include <cstdint>

namespace hashphase::detail {

/// Numbers objects by their addresses, for bytes in which addresses mean nothing.
class ObjectNumbers {
public:
    static constexpr std::uint32_t kNone = FlatSet::kNone;

    /// The next number. An address that has one keeps it.
    void add(const void* object) { addresses_.findOrInsert(keyOf(object)); }
    /// kNone of what was not added, and of null.
    [[nodiscard]] std::uint32_t of(const void* object) const noexcept {
        return addresses_.find(keyOf(object));
    }
    [[nodiscard]] bool has(const void* object) const noexcept {
        return addresses_.contains(keyOf(object));
    }
    void clear() noexcept { addresses_.clear(); }
    /// So that no add() takes memory until there are more.
    void reserve(std::size_t count) { addresses_.reserve(count); }
    [[nodiscard]] std::size_t memoryBytes() const noexcept { return addresses_.memoryBytes(); }
    [[nodiscard]] std::size_t size() const noexcept { return addresses_.size(); }

private:
    [[nodiscard]] static std::uint64_t keyOf(const void* object) noexcept {
        return reinterpret_cast<std::uintptr_t>(object);
    }

    FlatSet addresses_;
};

}  // namespace hashphase::detail
