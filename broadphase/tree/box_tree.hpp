// SPDX-License-Identifier: Zlib
#pragma once

// What rays read: a tree over the boxes of a table, eight children a node. The table's cells serve
// searches that look at one place; a ray looks at a line through all of them, most of it empty, and
// boxes around eight, 64, 512 neighbours tell it sooner than cells where nothing is.
//
// Neighbours are found by sorting along a Hilbert curve, one tree for each level of the table, so
// that large boxes do not fatten the nodes around small ones. Bounds are in single precision, rounded
// outward, in either precision of the table.
//
// Threads   build() needs the tree for itself; everything const may run anywhere.

#include <broadphase/hash/table.hpp>
#include <broadphase/simd/ray_types.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace hashphase::detail {

/// The tree of one level. Its blocks stand together: the lowest first, the root last.
struct BoxTreeLevel {
    std::uint32_t firstBlock = 0;
    std::uint32_t firstInner = 0;  // blocks from here on stand above blocks
    std::uint32_t root = 0;
    std::uint32_t count = 0;  // of boxes
    double radius = 0;  // [m] no bound is farther from the origin on any axis; may be infinite
};

class BoxTree {
public:
    /// Files the boxes of the table, but for those erased, or the larger ones that `filedBox` tells of its entries.
    /// Cost: a sort and two passes over the boxes; allocates only while the table is larger than any before.
    template <class Scalar>
    void build(const Table<Scalar>& table, typename Table<Scalar>::BoxOfEntry filedBox);
    template <class Scalar>
    void build(const Table<Scalar>& table) {
        build(table, [&](std::uint32_t entry) { return table.box(entry); });
    }

    /// What bounds are relative to [m].
    [[nodiscard]] const std::array<double, 3>& origin() const noexcept { return origin_; }
    [[nodiscard]] std::span<const BoxTreeLevel> levels() const noexcept { return levels_; }
    [[nodiscard]] const TreeNode8* blocks() const noexcept { return blocks_.data(); }
    [[nodiscard]] std::size_t memoryBytes() const noexcept;
    /// Gives back what only build() uses, and room for more boxes than there are.
    void releaseUnusedMemory() noexcept;

    /// Says which invariant is broken, in a sentence; empty when all hold:
    /// - Every block but the roots stands below one lane of one block, in the lane's box.
    /// - A block has one to eight boxes; lanes without a box are met by nothing.
    /// - A level's radius covers its boxes.
    [[nodiscard]] std::string validate() const;

    /// What is copied: core/copy_parts.hpp.
    template <class Visit>
    static void forEachPart(BoxTree& to, const BoxTree& from, const Visit& visit) {
        visit(to.origin_, from.origin_);
        visit(to.levels_, from.levels_);
        visit(to.blocks_, from.blocks_);
    }

private:
    struct Box {
        std::array<float, 3> low;
        std::array<float, 3> high;
        std::uint32_t children;  // index, or block

        [[nodiscard]] float longestEdge() const noexcept;
        void extend(const Box& other) noexcept;
    };
    struct Place {
        std::uint64_t onCurve;
        std::uint32_t box;
    };

    [[nodiscard]] static Box boxOf(const TreeNode8& block, std::uint32_t lane);
    template <class Scalar>
    void readBoxes(const Table<Scalar>& table, const Level<Scalar>& level,
                   typename Table<Scalar>::BoxOfEntry filedBox);
    [[nodiscard]] float curveStep();
    void sortAlongCurve();
    void sortPlaces(int bits);
    void buildLevel();
    void buildParents();
    [[nodiscard]] std::uint32_t neighbours(std::uint32_t first, float farApart) const;

    std::array<double, 3> origin_{};
    std::vector<BoxTreeLevel> levels_;
    std::vector<TreeNode8> blocks_;

    std::vector<Box> boxes_;      // scratch of build(): one level's, then those of a storey
    std::vector<Box> unsorted_;   // the same
    std::vector<Place> places_;   // the same
    std::vector<Place> places2_;  // the same
};

extern template void BoxTree::build(const Table<float>&, Table<float>::BoxOfEntry);
extern template void BoxTree::build(const Table<double>&, Table<double>::BoxOfEntry);

}  // namespace hashphase::detail
