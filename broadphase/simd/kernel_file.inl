// SPDX-License-Identifier: Zlib

// Kernel part: finds the buckets of boxes. See kernels.inl.

template <class Scalar>
bool isWithin(const Level<Scalar>& level, const std::int32_t* cell) {
    bool result = true;
    for (int axis = 0; axis < 3; ++axis) {
        result &= (level.low[axis] <= cell[axis]) & (cell[axis] <= level.high[axis]);
    }
    return result;
}

template <class Scalar>
void fileBoxes(const Level<Scalar>* levels, std::size_t levelCount, const PaddedBox<Scalar>* boxes,
               std::size_t count, std::uint32_t* buckets) {
    const std::size_t listed = levelCount - 1;
    for (std::size_t i = 0; i < count; ++i) {
        const PaddedBox<Scalar>& box = boxes[i];
        std::size_t number = 0;
        std::int32_t cell[4] = {};
        // The finest cells that are no smaller than the box, or, where rounding makes it span three
        // of these, coarser ones. Only the cells themselves decide, so that no rounding can file a
        // box where it is not looked for.
        while (number < listed &&
               !(fitsEdge(levels[number], box) && quantiseCorners(levels[number], box, cell))) {
            number += 2;
        }
        if (number == listed) {
            buckets[i] = isNan(box) ? kNoBucket : levels[listed].firstBucket;
            continue;
        }
        const Level<Scalar>& level = levels[number + (isWithin(levels[number], cell) ? 0 : 1)];
        buckets[i] = level.firstBucket + level.bucket(cell[0], Row{cell[1], cell[2]});
    }
}
