// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/core/compiler.hpp>
#include <broadphase/diagnostics.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace hashphase::detail {

/// A list for which room is made beforehand: to append an item is to write it, and cannot fail.
template <class Item>
class RoomyList {
public:
    using value_type = Item;

    /// Makes room for `count` items altogether.
    void reserve(std::size_t count) {
        if (count > room_.size()) {
            room_.resize(count);
        }
    }
    /// Makes room for `count` items more than there are; grows by half.
    void reserveMore(std::size_t count) {
        if (room_.size() - size_ < count) {
            reserve(room_.size() + room_.size() / 2 + count);
        }
    }
    // NOLINTNEXTLINE(readability-identifier-naming): named as std::vector's
    [[HASHPHASE_ALWAYS_INLINE]] void push_back(const Item& item) noexcept {
        HASHPHASE_ASSERT(size_ < room_.size(),
                         "RoomyList::push_back(): the list is full. Call reserve() first.");
        room_.data()[size_++] = item;
    }
    void clear() noexcept { size_ = 0; }

    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
    [[nodiscard]] const Item& operator[](std::size_t i) const noexcept { return room_.data()[i]; }
    [[nodiscard]] const Item* begin() const noexcept { return room_.data(); }
    [[nodiscard]] const Item* end() const noexcept { return room_.data() + size_; }
    [[nodiscard]] std::size_t capacity() const noexcept { return room_.size(); }

    /// See core/copy_parts.hpp.
    void makeRoomFor(const RoomyList& from) { reserve(from.size()); }
    void copyFrom(const RoomyList& from) noexcept {
        size_ = from.size_;
        std::copy(from.begin(), from.end(), room_.begin());
    }

private:
    std::vector<Item> room_;
    std::size_t size_ = 0;
};

}  // namespace hashphase::detail
