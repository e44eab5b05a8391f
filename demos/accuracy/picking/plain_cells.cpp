// SPDX-License-Identifier: Zlib
#include <demos/accuracy/picking/plain_cells.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace hashphase::demos {
namespace {

using Entry = std::pair<Cell, std::uint32_t>;

std::int64_t cellOf(float coordinate) {
    return static_cast<std::int64_t>(std::floor(coordinate));
}

std::vector<Entry> sortedEntries(std::span<const Aabb<float>> boxes, bool isFlat) {
    std::vector<Entry> entries;
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        const Aabb<float>& box = boxes[i];
        const std::int64_t lowY = isFlat ? 0 : cellOf(box.min().y());
        const std::int64_t highY = isFlat ? 0 : cellOf(box.max().y());
        for (std::int64_t x = cellOf(box.min().x()); x <= cellOf(box.max().x()); ++x) {
            for (std::int64_t y = lowY; y <= highY; ++y) {
                for (std::int64_t z = cellOf(box.min().z()); z <= cellOf(box.max().z()); ++z) {
                    entries.push_back({{x, y, z}, i});
                }
            }
        }
    }
    std::sort(entries.begin(), entries.end());
    return entries;
}

}  // namespace

PlainCells::PlainCells(std::span<const Aabb<float>> boxes, bool isFlat) : isFlat_(isFlat) {
    const std::vector<Entry> entries = sortedEntries(boxes, isFlat);
    slots_.resize(std::bit_ceil(2 * entries.size() + 1));
    for (const auto& [cell, box] : entries) {
        const auto place = static_cast<std::uint32_t>(boxes_.size());
        Slot& slot = slots_[slotOf(cell)];
        if (slot.begin == slot.end) {
            slot = {cell, place, place};
        }
        boxes_.push_back(box);
        slot.end = place + 1;
    }
}

std::span<const std::uint32_t> PlainCells::boxesIn(const Cell& cell) const {
    const Slot& slot = slots_[slotOf(cell)];
    return std::span(boxes_).subspan(slot.begin, slot.end - slot.begin);
}

// The cell's slot, or the free one where it would be.
std::size_t PlainCells::slotOf(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const std::int64_t index : cell) {
        hash = (hash ^ static_cast<std::uint64_t>(index)) * 0x9e3779b97f4a7c15U;  // 2^64 by phi
        hash ^= hash >> 32;
    }
    std::size_t i = hash & (slots_.size() - 1);
    while (slots_[i].begin != slots_[i].end && slots_[i].cell != cell) {
        i = (i + 1) & (slots_.size() - 1);
    }
    return i;
}

}  // namespace hashphase::demos
