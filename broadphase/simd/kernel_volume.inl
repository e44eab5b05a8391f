// SPDX-License-Identifier: Zlib

// Kernel part: finds what is in a convex volume. See kernels.inl.
//
// Layers of cells are clipped by the planes across z, the rows of a layer by the planes along x, and
// the cells of a row, some rows at a time, by all. What of a row lies wholly inside is taken; what is
// left on either side of it is tested against the planes that part it.

// Looking up a row of cells costs about as much as testing this many boxes, some at a time.
constexpr std::uint64_t kBoxesPerVolumeRow = 8;

template <class Scalar>
Scalar absolute(Scalar x) {
    return x < 0 ? -x : x;
}

template <class Scalar>
Scalar smaller(Scalar a, Scalar b) {
    return a < b ? a : b;
}

template <class Scalar>
Scalar larger(Scalar a, Scalar b) {
    return a < b ? b : a;
}

/// Between which coordinates boxes lie.
template <class Scalar>
struct Hull {
    Scalar low[3];
    Scalar high[3];
};

/// From low to high; empty where low > high.
template <class Number>
struct Interval {
    Number low;
    Number high;

    [[nodiscard]] bool isEmpty() const { return !(low <= high); }
    [[nodiscard]] std::uint64_t count() const {
        return isEmpty() ? 0 : static_cast<std::uint64_t>(high - low) + 1;
    }
};

using CellInterval = Interval<std::int32_t>;

/// A plane of a volume, and the columns in which it finds the corners of boxes that decide.
template <class Scalar>
struct BoxPlane {
    Scalar slope[3];
    Scalar offset;
    Scalar slack;  // twice what counts as rounding anywhere on the level, or more
    const Scalar* corner[3];
};

/// A level as a volume sees it.
template <class Scalar>
class VolumeView {
public:
    VolumeView(const Level<Scalar>& itsLevel, const Volume<Scalar>& itsVolume)
        : level(itsLevel), volume(itsVolume) {
        for (int axis = 0; axis < 3; ++axis) {
            all.low[axis] = level.lowest[axis];
            all.high[axis] = level.highest[axis];
            isFlat[axis] = level.inverseCellSize[axis] == 0;
            if (!isFlat[axis]) {
                const Scalar size = 1 / level.inverseCellSize[axis];
                const auto first = static_cast<Scalar>(level.low[axis]);
                const auto last = static_cast<Scalar>(level.high[axis] + 2);
                const Scalar reach = larger(absolute(first), absolute(last)) * size;
                const Scalar margin =
                    2 * volume.rounding * (absolute(level.origin[axis]) + reach + size) +
                    volume.tiny;
                cellSize_[axis] = size;
                lowOrigin_[axis] = level.origin[axis] - margin;
                highOrigin_[axis] = level.origin[axis] + 2 * size + margin;
                setCells(axis, level.low[axis], level.high[axis], all);
            }
        }
        for (std::uint32_t i = 0; i < volume.planeCount; ++i) {
            BoxPlane<Scalar>& plane = planes[i];
            plane.offset = volume.offset[i];
            Scalar size = absolute(plane.offset);
            for (int axis = 0; axis < 3; ++axis) {
                const Scalar slope = volume.slope[axis][i];
                const bool takesMax = (slope > 0) != volume.isInside;
                plane.slope[axis] = slope;
                plane.corner[axis] = level.columns[axis + (takesMax ? 3 : 0)];
                size += absolute(slope) * larger(absolute(all.low[axis]), absolute(all.high[axis]));
            }
            plane.slack = 2 * volume.rounding * size + volume.tiny;
        }
    }

    /// Along an axis that is not flat, where the boxes begin that are filed in a cell, and where those
    /// end, which reach into the next cell.
    [[nodiscard]] Scalar beginOf(std::int32_t cell, int axis) const {
        return lowOrigin_[axis] + static_cast<Scalar>(cell) * cellSize_[axis];
    }
    [[nodiscard]] Scalar endOf(std::int32_t cell, int axis) const {
        return highOrigin_[axis] + static_cast<Scalar>(cell) * cellSize_[axis];
    }

    /// Sets the hull's extent along the axis to that of the boxes filed in cells first to last; leaves
    /// it as it is where the axis is flat.
    void setCells(int axis, std::int32_t first, std::int32_t last, Hull<Scalar>& hull) const {
        if (!isFlat[axis]) {
            hull.low[axis] = beginOf(first, axis);
            hull.high[axis] = endOf(last, axis);
        }
    }

    /// The part of the hull along the axis that may be in the volume, by the planes that slope along
    /// it and along none before it.
    [[nodiscard]] Interval<Scalar> clip(const Hull<Scalar>& hull, int axis) const {
        Interval<Scalar> part{hull.low[axis], hull.high[axis]};
        for (std::uint32_t i = 0; i < volume.planeCount; ++i) {
            const BoxPlane<Scalar>& plane = planes[i];
            const Scalar slope = plane.slope[axis];
            const bool isDecided = plane.slope[0] == 0 && (axis == 1 || plane.slope[1] == 0);
            if (slope == 0 || !isDecided) {
                continue;
            }
            Scalar most = plane.offset + plane.slack;
            for (int other = axis + 1; other < 3; ++other) {
                most += larger(plane.slope[other] * hull.low[other],
                               plane.slope[other] * hull.high[other]);
            }
            if (slope > 0) {
                part.low = larger(part.low, -most / slope);
            } else {
                part.high = smaller(part.high, -most / slope);
            }
        }
        return part;
    }

    /// The cells along the axis in which boxes may be filed that touch a part of the level.
    [[nodiscard]] CellInterval cellsOf(const Interval<Scalar>& part, int axis) const {
        if (part.isEmpty()) {
            return {1, 0};
        }
        const auto at = static_cast<std::size_t>(axis);
        return {larger(level.cell(part.low, at) - 1, level.low[axis]),
                smaller(level.cell(part.high, at), level.high[axis])};
    }

    /// The least that a plane may be found to sum up to over the boxes of a hull, and the most.
    [[nodiscard]] Interval<Scalar> sumOver(const BoxPlane<Scalar>& plane,
                                           const Hull<Scalar>& hull) const {
        Interval<Scalar> sum{plane.offset - plane.slack, plane.offset + plane.slack};
        for (int axis = 0; axis < 3; ++axis) {
            const Scalar atLow = plane.slope[axis] * hull.low[axis];
            const Scalar atHigh = plane.slope[axis] * hull.high[axis];
            sum.low += smaller(atLow, atHigh);
            sum.high += larger(atLow, atHigh);
        }
        return sum;
    }

    const Level<Scalar>& level;
    const Volume<Scalar>& volume;
    Hull<Scalar> all;  // of all boxes of the level
    bool isFlat[3];
    BoxPlane<Scalar> planes[kMostVolumePlanes];

private:
    Scalar cellSize_[3];
    Scalar lowOrigin_[3];
    Scalar highOrigin_[3];
};

/// Bit i stands for plane i of a volume.
using PlaneSet = std::uint64_t;
static_assert(kMostVolumePlanes <= 64);

inline std::uint32_t firstPlane(PlaneSet planes) {
    return lowestBit(planes);
}

// Writes numbers[k] for every bit k; may write up to the width of a Pack. Returns where the next one
// goes.
template <class Pack>
std::uint32_t* writeNumbers(std::uint32_t mask, const std::uint32_t* numbers, std::uint32_t* next) {
    if constexpr (requires { Pack::compress(mask, numbers, next); }) {
        Pack::compress(mask, numbers, next);
        return next + bitCount(mask);
    } else {
        for (; mask != 0; mask &= mask - 1) {
            *next++ = numbers[lowestBit(mask)];
        }
        return next;
    }
}

#include <broadphase/simd/kernel_volume_rows.inl>

#include <broadphase/simd/kernel_volume_read.inl>

// Calls visit(batch), which empties it, for batches of the rows that the volume's planes leave along y
// and z. Returns false as soon as visit() does.
template <class Scalar, class Visit>
bool forRowBatches(const VolumeView<Scalar>& view, PlaneSet crossing, CellInterval layers,
                   CellInterval rowsOfAll, const Visit& visit) {
    RowBatch<Scalar> batch(view, crossing);
    for (std::int32_t z = layers.low; z <= layers.high; ++z) {
        CellInterval rows = rowsOfAll;
        if (rowsOfAll.count() > 1) {
            Hull<Scalar> layer = view.all;
            view.setCells(2, z, z, layer);
            rows = view.cellsOf(view.clip(layer, 1), 1);
        }
        for (std::int32_t y = rows.low; y <= rows.high; ++y) {
            if (batch.add(Row{y, z}) && !visit(batch)) {
                return false;
            }
        }
    }
    return visit(batch);
}

// Whether the volume has as many cells as a hashed level has buckets. Rows share these: every box might
// be read once a row.
template <class Scalar>
bool coversBuckets(const VolumeView<Scalar>& view, PlaneSet crossing, CellInterval layers,
                   CellInterval rows) {
    const Level<Scalar>& level = view.level;
    const std::uint64_t longest = CellInterval{level.low[0], level.high[0]}.count();
    if (level.isDense() || layers.count() * rows.count() * longest < level.bucketCount) {
        return false;
    }
    std::uint64_t cells = 0;
    return !forRowBatches(view, crossing, layers, rows, [&](RowBatch<Scalar>& batch) {
        cells += batch.countCells();
        batch.count = 0;
        return cells < level.bucketCount;
    });
}

template <class Scalar>
bool walkVolume(const Level<Scalar>& level, const Volume<Scalar>& volume, IndexSink& found,
                KernelCost& cost) {
    const VolumeView<Scalar> view(level, volume);
    PlaneSet crossing = 0;
    for (std::uint32_t i = 0; i < volume.planeCount; ++i) {
        const Interval<Scalar> sum = view.sumOver(view.planes[i], view.all);
        if (sum.high < 0) {
            return true;
        }
        if (!(sum.low >= 0)) {
            crossing |= PlaneSet{1} << i;
        }
    }
    VolumeReader<Scalar> reader(view, crossing, found, cost);
    const Run all = {level.firstEntry, level.lastEntry};
    if (crossing == 0) {
        return reader.take(all);
    }
    const CellInterval layers = view.cellsOf(view.clip(view.all, 2), 2);
    const CellInterval rows = view.cellsOf(view.clip(view.all, 1), 1);
    if (layers.count() * rows.count() * kBoxesPerVolumeRow > all.last - all.first ||
        coversBuckets(view, crossing, layers, rows)) {
        return reader.test(all);
    }
    return forRowBatches(view, crossing, layers, rows,
                         [&reader](RowBatch<Scalar>& batch) { return reader.readRows(batch); });
}
