// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/hash/table.hpp>

#include <cstdint>
#include <numeric>
#include <vector>

namespace hashphase::test {

/// Files boxes[i] as slot i.
template <class Scalar>
void fill(detail::Table<Scalar>& table, const std::vector<Aabb<Scalar>>& boxes,
          const detail::LevelSizes& sizes = {}) {
    std::vector<std::uint32_t> slots(boxes.size());
    std::iota(slots.begin(), slots.end(), 0U);
    std::vector<detail::PaddedBox<Scalar>> padded;
    for (const Aabb<Scalar>& box : boxes) {
        padded.push_back(detail::padded(box));
    }
    table.build(slots, padded, sizes);
}

}  // namespace hashphase::test
