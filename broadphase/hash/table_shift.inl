// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/geometry/origin_shift.hpp>
#include <broadphase/hash/shift_column.hpp>
#include <broadphase/hash/table.hpp>

namespace hashphase::detail {

// Cells are counted from an origin that is shifted along: where neither it nor a coordinate is
// rounded, a coordinate is as far from it as it was, and in the same cell.
template <class Scalar>
bool Table<Scalar>::shiftOrigin(const Vector3<Scalar>& shift) {
    bool isFiled = true;
    for (Level<Scalar>& level : levels_) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Scalar by = shift[static_cast<Eigen::Index>(axis)];
            const Scalar origin = shiftedWithin(level.origin[axis], by);
            bool isExact = isExactDifference(level.origin[axis], by, origin);
            level.origin[axis] = origin;
            level.lowest[axis] -= by;
            level.highest[axis] -= by;
            for (const std::size_t column : {axis, axis + 3}) {
                isExact &=
                    shiftColumn(bounds_[column].data() + level.firstEntry, level.count(), by);
            }
            isFiled &= isExact || !level.hasCells() || level.count() == 0;
        }
    }
    if (layout_ != nullptr) {
        layout_->shiftOrigin(shift);
    }
    return isFiled;
}

}  // namespace hashphase::detail
