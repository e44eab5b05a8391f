// SPDX-License-Identifier: Zlib
#pragma once

// Walks a BoxTree along a ray, from near to far.

#include <broadphase/regions.hpp>
#include <broadphase/search/walk.hpp>
#include <broadphase/tree/box_tree.hpp>
#include <broadphase/tree/tree_ray.hpp>

#include <array>
#include <bit>
#include <cstdint>

namespace hashphase::detail {

/// The lane of `mask`, which has one, with the smallest number.
inline std::uint32_t nearestLane(const std::array<float, kBlockWidth>& enters, std::uint32_t mask) {
    auto nearest = static_cast<std::uint32_t>(std::countr_zero(mask));
    for (mask &= mask - 1; mask != 0; mask &= mask - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(mask));
        nearest = enters[lane] < enters[nearest] ? lane : nearest;
    }
    return nearest;
}

/// Offers to reader.read(slot) -> bool, false to stop, each box of the level that the ray may meet
/// up to the key reader.limit(), roughly from near to far. Returns false when stopped.
template <class Scalar, class Reader>
bool walkTreeLevel(const BoxTree& tree, const BoxTreeLevel& level, const TreeRay<Scalar>& ray,
                   QueryCost& cost, Reader&& reader) {
    struct Pending {
        float enter;
        std::uint32_t block;
    };
    // Each of at most 32 storeys leaves seven behind.
    std::array<Pending, 256> pending;
    std::uint32_t count = 1;
    pending[0] = {0, level.root};
    const RayLanes& lanes = ray.lanes();
    float last = ray.lastFor(static_cast<double>(reader.limit()));
    std::uint64_t blocksRead = 0;
    std::uint64_t boxesTested = 0;
    bool goOn = true;
    while (count > 0 && goOn) {
        const auto [enter, index] = pending[--count];
        if (enter > last) {
            continue;
        }
        const BoxBlock& block = tree.blocks()[index];
        std::array<float, kBlockWidth> enters;
        std::uint32_t mask = mayMeetMask(block, lanes, last, enters.data());
        ++blocksRead;
        if (index < level.firstInner) {
            boxesTested += block.count;
            while (mask != 0 && goOn) {
                const std::uint32_t k = nearestLane(enters, mask);
                mask ^= 1U << k;
                if (enters[k] <= last) {
                    goOn = reader.read(block.below[k]);
                    last = ray.lastFor(static_cast<double>(reader.limit()));
                }
            }
            continue;
        }
        // The nearest on top.
        const std::uint32_t bottom = count;
        for (; mask != 0; mask &= mask - 1) {
            const auto k = static_cast<std::size_t>(std::countr_zero(mask));
            std::uint32_t i = count++;
            for (; i > bottom && pending[i - 1].enter < enters[k]; --i) {
                pending[i] = pending[i - 1];
            }
            pending[i] = {enters[k], block.below[k]};
        }
    }
    cost.rowsVisited += blocksRead;
    cost.boxesTested += boxesTested;
    return goOn;
}

/// The same for every box of the level.
template <class Reader>
bool readWholeLevel(const BoxTree& tree, const BoxTreeLevel& level, QueryCost& cost,
                    Reader&& reader) {
    for (std::uint32_t index = level.firstBlock; index < level.firstInner; ++index) {
        const BoxBlock& block = tree.blocks()[index];
        cost.boxesTested += block.count;
        for (std::uint32_t k = 0; k < block.count; ++k) {
            if (!reader.read(block.below[k])) {
                return false;
            }
        }
    }
    return true;
}

/// walkTreeLevel() over all levels.
template <class Scalar, class Reader>
bool walkTree(const BoxTree& tree, const RayRegion<Scalar>& region, QueryCost& cost,
              Reader&& reader) {
    if (tree.levels().empty() || region.isEmpty()) {
        return true;
    }
    TreeRay<Scalar> ray(region, tree.origin());
    for (const BoxTreeLevel& level : tree.levels()) {
        if (!ray.clipTo(level.radius)) {
            continue;
        }
        if (!ray.isExpressible()) {
            if (!readWholeLevel(tree, level, cost, reader)) {
                return false;
            }
            continue;
        }
        if (!walkTreeLevel(tree, level, ray, cost, reader)) {
            return false;
        }
    }
    return true;
}

}  // namespace hashphase::detail
