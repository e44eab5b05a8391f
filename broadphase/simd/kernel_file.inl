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
void fileBoxes(const SizeClass<Scalar>* classes, std::size_t classCount, std::uint32_t listBucket,
               const PaddedBox<Scalar>* boxes, std::size_t count, std::uint32_t* buckets) {
    const SizeClass<Scalar>* const end = classes + classCount;
    for (std::size_t i = 0; i < count; ++i) {
        const PaddedBox<Scalar>& box = boxes[i];
        const SizeClass<Scalar>* sized = classes;
        std::int32_t cell[4] = {};
        // The finest cells that are no smaller than the box, or, where rounding makes it span three
        // of these, coarser ones. Only the cells themselves decide, so that no rounding can file a
        // box where it is not looked for.
        while (sized != end &&
               !(fitsEdge(*sized->dense, box) && quantiseCorners(*sized->dense, box, cell))) {
            ++sized;
        }
        if (sized == end) {
            buckets[i] = isNan(box) ? kNoBucket : listBucket;
            continue;
        }
        const Level<Scalar>& level = isWithin(*sized->dense, cell) ? *sized->dense : *sized->hashed;
        buckets[i] = level.firstBucket + level.bucket(cell[0], Row{cell[1], cell[2]});
    }
}
