// SPDX-License-Identifier: Zlib
#pragma once

// A table beside the list of boxes that it holds.

#include <broadphase/geometry/box_columns.hpp>
#include <broadphase/hash/table.hpp>
#include <broadphase/search/join.hpp>
#include <broadphase/simd/kernels.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>
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

using IndexPairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// Pairs (i, k) of queries[i] and boxes[k] that overlap, sorted.
template <class Scalar>
[[nodiscard]] IndexPairs overlapsByBruteForce(const std::vector<Aabb<Scalar>>& queries,
                                              const std::vector<Aabb<Scalar>>& boxes) {
    IndexPairs pairs;
    for (std::uint32_t i = 0; i < queries.size(); ++i) {
        for (std::uint32_t k = 0; k < boxes.size(); ++k) {
            if (overlaps(queries[i], boxes[k])) {
                pairs.emplace_back(i, k);
            }
        }
    }
    return pairs;
}

template <class Scalar>
[[nodiscard]] detail::BoxColumns<Scalar> columnsOf(const std::vector<Aabb<Scalar>>& boxes) {
    detail::BoxColumns<Scalar> columns;
    for (const Aabb<Scalar>& box : boxes) {
        columns.push(box);
    }
    return columns;
}

/// A table, its boxes, and what the last search in it has cost.
template <class Scalar>
struct FilledTable {
    using Box = Aabb<Scalar>;

    void build(std::vector<Box> itsBoxes, const detail::LevelSizes& sizes = {}) {
        boxes = std::move(itsBoxes);
        fill(table, boxes, sizes);
        ASSERT_EQ(table.validate(), "");
    }
    /// Erases each `each`-th entry; of its box nothing is left.
    void eraseEach(std::uint32_t each) {
        for (std::uint32_t entry = 0; entry < table.size(); entry += each) {
            boxes[table.proxyIndex(entry)].min().setConstant(
                std::numeric_limits<Scalar>::quiet_NaN());
            table.erase(entry);
        }
        ASSERT_EQ(table.validate(), "");
    }

    /// Every pair of the boxes, in the order of their indices, found by the join.
    [[nodiscard]] IndexPairs joined() {
        cost = {};
        detail::PairList found;
        detail::PairParts parts;
        joinTable(table, serialFor, parts, found, cost);
        IndexPairs pairs;
        for (const auto [a, b] : found.pairs()) {
            pairs.push_back(std::minmax(table.proxyIndex(a), table.proxyIndex(b)));
        }
        std::sort(pairs.begin(), pairs.end());
        return pairs;
    }
    /// The same, found by looking for every box in the table.
    [[nodiscard]] IndexPairs walked() {
        cost = {};
        const detail::BoxColumns<Scalar> queries = columnsOf(boxes);
        detail::PairList found;
        detail::PairParts parts;
        queryTable(table, queries.columns(), queries.size(), serialFor, parts, found, cost);
        IndexPairs pairs;
        for (const auto [query, entry] : found.pairs()) {
            if (query < table.proxyIndex(entry)) {
                pairs.emplace_back(query, table.proxyIndex(entry));
            }
        }
        std::sort(pairs.begin(), pairs.end());
        return pairs;
    }
    [[nodiscard]] IndexPairs expected() const {
        IndexPairs pairs = overlapsByBruteForce(boxes, boxes);
        std::erase_if(pairs, [](const auto& pair) { return pair.first >= pair.second; });
        return pairs;
    }
    /// Both find every pair once, with no more tests a box than said; returns how many there are.
    std::size_t expectEveryPairOnce(double mostJoinTests = 1e9, double mostWalkTests = 1e9) {
        const IndexPairs pairs = expected();
        const auto count = static_cast<double>(std::max<std::size_t>(boxes.size(), 1));
        EXPECT_EQ(joined(), pairs);
        EXPECT_LT(static_cast<double>(cost.boxesTested), mostJoinTests * count);
        EXPECT_EQ(walked(), pairs);
        EXPECT_LT(static_cast<double>(cost.boxesTested), mostWalkTests * count);
        return pairs.size();
    }

    std::vector<Box> boxes;
    detail::Table<Scalar> table;
    detail::KernelCost cost;
};

/// Calls visit(set) with each instruction set that there is in use, the scalar one first.
template <class Visit>
void forEachInstructionSet(const Visit& visit) {
    using detail::InstructionSet;
    const InstructionSet before = detail::instructionSet();
    for (const InstructionSet set : detail::kInstructionSets) {
        if (detail::isAvailable(set)) {
            detail::useInstructionSet(set);
            SCOPED_TRACE(detail::nameOf(set));
            visit(set);
        }
    }
    detail::useInstructionSet(before);
}

}  // namespace hashphase::test
