// SPDX-License-Identifier: Zlib
#pragma once

// Plain numbers one after the other as bytes, in the order of the processor, without gaps.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace hashphase::detail {

template <class Number>
concept PlainNumber = std::is_arithmetic_v<Number> || std::is_enum_v<Number>;

/// Appends to bytes whose memory it keeps.
class ByteWriter {
public:
    template <PlainNumber Number>
    void write(Number number) {
        std::memcpy(makeRoom(sizeof(number)), &number, sizeof(number));
    }
    void write(const void* from, std::size_t count) { std::memcpy(makeRoom(count), from, count); }

    /// Writes without looking for room each time: write(at) is given where to write up to `most` bytes, and returns
    /// where it has ended.
    template <class Write>
    void writeBlock(std::size_t most, const Write& write) {
        std::byte* const begin = makeRoom(most);
        size_ -= most - static_cast<std::size_t>(write(begin) - begin);
    }

    /// Replaces a number that was written `at` so many bytes from the beginning.
    template <PlainNumber Number>
    void rewrite(std::size_t at, Number number) noexcept {
        std::memcpy(room_.data() + at, &number, sizeof(number));
    }

    void clear() noexcept { size_ = 0; }
    [[nodiscard]] std::span<const std::byte> bytes() const noexcept {
        return std::span(room_).first(size_);
    }
    [[nodiscard]] std::size_t memoryBytes() const noexcept { return room_.capacity(); }

private:
    [[nodiscard]] std::byte* makeRoom(std::size_t count) {
        if (room_.size() - size_ < count) {
            room_.resize(2 * room_.size() + count);
        }
        size_ += count;
        return room_.data() + (size_ - count);
    }

    std::vector<std::byte> room_;
    std::size_t size_ = 0;
};

/// Reads what a ByteWriter has written. At the end, and beyond it, numbers are 0.
class ByteReader {
public:
    explicit ByteReader(std::span<const std::byte> bytes) noexcept : left_(bytes) {}

    template <PlainNumber Number>
    [[nodiscard]] Number read() noexcept {
        Number number{};
        read(&number, sizeof(number));
        return number;
    }
    void read(void* to, std::size_t count) noexcept {
        if (left_.size() < count) {
            left_ = {};
            isTorn_ = true;
            std::memset(to, 0, count);
            return;
        }
        std::memcpy(to, left_.data(), count);
        left_ = left_.subspan(count);
    }

    /// What is left.
    [[nodiscard]] std::span<const std::byte> rest() const noexcept { return left_; }
    void skip(std::size_t count) noexcept { left_ = left_.subspan(count); }
    /// How many bytes are left.
    [[nodiscard]] std::size_t left() const noexcept { return left_.size(); }
    /// Whether more was read than there was.
    [[nodiscard]] bool isTorn() const noexcept { return isTorn_; }

private:
    std::span<const std::byte> left_;
    bool isTorn_ = false;
};

}  // namespace hashphase::detail
