// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/depth_order.hpp>

#include <array>
#include <bit>

namespace hashphase::demos {

namespace {

constexpr std::uint32_t kDigitBits = 11;
constexpr std::uint32_t kDigits = 1U << kDigitBits;
constexpr std::uint32_t kDroppedBits = 32 - 2 * kDigitBits;  // of a float's last ones

void sortByDigit(std::span<const DepthOrder::Entry> from, std::span<DepthOrder::Entry> to,
                 std::uint32_t shift) {
    const auto digit = [shift](const DepthOrder::Entry& entry) {
        return (entry.key >> shift) & (kDigits - 1);
    };
    std::array<std::uint32_t, kDigits> places{};
    for (const DepthOrder::Entry& entry : from) {
        ++places[digit(entry)];
    }
    std::uint32_t next = 0;
    for (std::uint32_t& place : places) {
        const std::uint32_t count = place;
        place = next;
        next += count;
    }
    for (const DepthOrder::Entry& entry : from) {
        to[places[digit(entry)]++] = entry;
    }
}

}  // namespace

void DepthOrder::add(float depth, std::uint32_t index) {
    // The bits of positive floats are in the order of the floats; inverted, the farthest come
    // first.
    entries_.push_back({~std::bit_cast<std::uint32_t>(depth) >> kDroppedBits, index});
}

std::span<const DepthOrder::Entry> DepthOrder::sort() {
    sorted_.resize(entries_.size());
    sortByDigit(entries_, sorted_, 0);
    sortByDigit(sorted_, entries_, kDigitBits);
    return entries_;
}

}  // namespace hashphase::demos
