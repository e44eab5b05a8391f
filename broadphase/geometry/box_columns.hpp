// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/hash/table.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::detail {

/// Boxes to be looked for in a table, by column. Keeps its memory.
template <class Scalar>
class BoxColumns {
public:
    void clear() noexcept {
        for (auto& column : columns_) {
            column.clear();
        }
    }

    void push(const Aabb<Scalar>& box) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto at = static_cast<Eigen::Index>(axis);
            columns_[axis].push_back(box.min()[at]);
            columns_[axis + 3].push_back(box.max()[at]);
        }
    }

    [[nodiscard]] std::uint32_t size() const noexcept {
        return static_cast<std::uint32_t>(columns_[0].size());
    }
    [[nodiscard]] Columns<Scalar> columns() const noexcept {
        return {columns_[0].data(), columns_[1].data(), columns_[2].data(),
                columns_[3].data(), columns_[4].data(), columns_[5].data()};
    }
    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return 6 * columns_[0].capacity() * sizeof(Scalar);
    }

private:
    std::array<std::vector<Scalar>, 6> columns_;
};

/// The same for the bounds of a few regions, on the stack.
template <class Scalar>
class QueryColumns {
public:
    static constexpr std::size_t kMost = 16;

    template <class Region>
    explicit QueryColumns(std::span<const Region> regions) noexcept {
        for (std::size_t i = 0; i < regions.size(); ++i) {
            const Aabb<Scalar>& box = regions[i].bounds();
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto at = static_cast<Eigen::Index>(axis);
                columns_[axis][i] = box.min()[at];
                columns_[axis + 3][i] = box.max()[at];
            }
        }
    }

    [[nodiscard]] Columns<Scalar> columns() const noexcept {
        return {columns_[0].data(), columns_[1].data(), columns_[2].data(),
                columns_[3].data(), columns_[4].data(), columns_[5].data()};
    }

private:
    std::array<std::array<Scalar, kMost>, 6> columns_;
};

}  // namespace hashphase::detail

#include <broadphase/core/restore_macros.hpp>
