// SPDX-License-Identifier: Zlib

// The corners of boxes without vector instructions. See kernels.inl.

// False for boxes with infinite edges or NaN.
template <class Scalar>
bool fitsEdge(const Level<Scalar>& level, const PaddedBox<Scalar>& box) {
    return (box.high[0] - box.low[0] <= level.largestEdge) &
           (box.high[1] - box.low[1] <= level.largestEdge) &
           (box.high[2] - box.low[2] <= level.largestEdge);
}

template <class Scalar>
bool quantiseCorners(const Level<Scalar>& level, const PaddedBox<Scalar>& box, std::int32_t* low) {
    bool isFine = true;
    for (int axis = 0; axis < 3; ++axis) {
        low[axis] = quantise(box.low[axis], level.origin[axis], level.inverseCellSize[axis]);
        const std::int32_t high =
            quantise(box.high[axis], level.origin[axis], level.inverseCellSize[axis]);
        isFine &= static_cast<std::uint32_t>(high - low[axis]) <= 1U && low[axis] > -kCellLimit &&
                  high < kCellLimit;
    }
    return isFine;
}
