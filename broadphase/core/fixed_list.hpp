// SPDX-License-Identifier: Zlib
#pragma once

#include <array>
#include <cstddef>

namespace hashphase::detail {

/// A list that lives where it is declared and has room for `kMost` items.
template <class Item, std::size_t kMost>
class FixedList {
public:
    /// False, and nothing appended, when the list is full.
    bool push(const Item& item) {
        if (size_ == kMost) {
            return false;
        }
        items_[size_++] = item;
        return true;
    }
    void clear() noexcept { size_ = 0; }

    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
    [[nodiscard]] const Item& operator[](std::size_t i) const noexcept { return items_[i]; }
    [[nodiscard]] Item* begin() noexcept { return items_.data(); }
    [[nodiscard]] Item* end() noexcept { return items_.data() + size_; }
    [[nodiscard]] const Item* data() const noexcept { return items_.data(); }
    [[nodiscard]] const Item* begin() const noexcept { return items_.data(); }
    [[nodiscard]] const Item* end() const noexcept { return items_.data() + size_; }

private:
    std::array<Item, kMost> items_;
    std::size_t size_ = 0;
};

}  // namespace hashphase::detail
