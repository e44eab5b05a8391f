// SPDX-License-Identifier: Zlib

// Kernel part: finds what is in a convex volume. See kernels.inl.
//
// Layers of cells are clipped by the planes across z, the rows of a layer by the planes along x, and
// the cells of a row, some rows at a time, by all. What remains of a row is tested against the planes
// that cross it, and taken where none does.

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

    bool isEmpty() const { return !(low <= high); }
    std::uint64_t count() const {
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
    VolumeView(const LevelView<Scalar>& itsLevel, const Volume<Scalar>& itsVolume)
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
    Scalar beginOf(std::int32_t cell, int axis) const {
        return lowOrigin_[axis] + static_cast<Scalar>(cell) * cellSize_[axis];
    }
    Scalar endOf(std::int32_t cell, int axis) const {
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
    Interval<Scalar> clip(const Hull<Scalar>& hull, int axis) const {
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
    CellInterval cellsOf(const Interval<Scalar>& part, int axis) const {
        if (part.isEmpty()) {
            return {1, 0};
        }
        return {larger(cellOf(level, part.low, axis) - 1, level.low[axis]),
                smaller(cellOf(level, part.high, axis), level.high[axis])};
    }

    /// The least that a plane may be found to sum up to over the boxes of a hull, and the most.
    Interval<Scalar> sumOver(const BoxPlane<Scalar>& plane, const Hull<Scalar>& hull) const {
        Interval<Scalar> sum{plane.offset - plane.slack, plane.offset + plane.slack};
        for (int axis = 0; axis < 3; ++axis) {
            const Scalar atLow = plane.slope[axis] * hull.low[axis];
            const Scalar atHigh = plane.slope[axis] * hull.high[axis];
            sum.low += smaller(atLow, atHigh);
            sum.high += larger(atLow, atHigh);
        }
        return sum;
    }

    const LevelView<Scalar>& level;
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

inline std::uint32_t firstPlane(PlaneSet planes) {
    return static_cast<std::uint32_t>(__builtin_ctzll(planes));
}

// Writes numbers[k] for every bit k; may write up to the width of a Pack. Returns where the next one
// goes.
template <class Pack>
std::uint32_t* writeNumbers(std::uint32_t mask, const std::uint32_t* numbers, std::uint32_t* next) {
    if constexpr (requires { Pack::compress(mask, numbers, next); }) {
        Pack::compress(mask, numbers, next);
        return next + __builtin_popcount(mask);
    } else {
        for (; mask != 0; mask &= mask - 1) {
            *next++ = numbers[__builtin_ctz(mask)];
        }
        return next;
    }
}

#include <broadphase/detail/kernel_volume_rows.inl>

/// Lists the slots of a level's entries that are in a volume.
template <class Scalar>
class VolumeReader {
public:
    /// `crossing` are the planes that may part the boxes of the level.
    VolumeReader(const VolumeView<Scalar>& view, PlaneSet crossing, SlotSink& found,
                 KernelCost& cost)
        : view_(view), crossing_(crossing), found_(found), cost_(cost) {}

    /// Tests a run. Returns, as all members do, false when the search is to end.
    bool test(Run run) { return scan<true>(run, crossing_, Row{}); }

    /// Takes a run without a test.
    [[gnu::noinline]] bool take(Run run) {
        while (run.first < run.last) {
            const auto room = static_cast<std::uint32_t>(found_.end - found_.next);
            const std::uint32_t count = lowest(run.last - run.first, room);
            __builtin_memcpy(found_.next, view_.level.slots + run.first,
                             count * sizeof(*found_.next));
            found_.next += count;
            run.first += count;
            if (count == room && !found_.flush(found_)) {
                return false;
            }
        }
        return true;
    }

    /// Reads the rows of a batch, which lie in the volume as far as y and z go, and empties it.
    bool readRows(RowBatch<Scalar>& batch) {
        batch.clip();
        const int count = batch.count;
        batch.count = 0;
        return view_.level.isDense ? readDense(batch, count) : readHashed(batch, count);
    }

private:
    /// The entries of a row, those among them that are covered, and the planes that may part those
    /// before these, and those behind.
    struct RowRuns {
        Run all;
        Run covered;
        PlaneSet before;
        PlaneSet behind;
    };

    // What is read is fetched from memory for all rows at once.
    bool readDense(const RowBatch<Scalar>& batch, int count) {
        RowRuns rows[kRowsAtOnce];
        const int found = findRuns(batch, count, rows);
        for (int k = 0; k < found; ++k) {
            fetchSlots(rows[k].all);
            fetchColumns({rows[k].all.first, rows[k].covered.first}, rows[k].before);
            fetchColumns({rows[k].covered.last, rows[k].all.last}, rows[k].behind);
        }
        for (int k = 0; k < found; ++k) {
            if (!readRow(rows[k])) {
                return false;
            }
        }
        return true;
    }

    // Lists the rows that have cells; returns how many.
    int findRuns(const RowBatch<Scalar>& batch, int count, RowRuns* found) {
        const std::uint32_t* starts = view_.level.bucketStart;
        int foundCount = 0;
        for (int k = 0; k < count; ++k) {
            const std::uint32_t base = rowBase(view_.level, batch.rows[k]);
            const auto startOf = [starts, base](std::int32_t cell) {
                return starts[base + static_cast<std::uint32_t>(cell)];
            };
            const bool hasCells = batch.first[k] <= batch.last[k];
            if (hasCells) {
                const Run all{startOf(batch.first[k]), startOf(batch.last[k] + 1)};
                const bool hasCovered = batch.coveredFirst[k] <= batch.coveredLast[k];
                const PlaneSet crossing = batch.crossing[k];
                // Before what is covered, no plane has anything outside that a later cell has more of;
                // nor the other way round behind it.
                found[foundCount++] = hasCovered ? RowRuns{all,
                                                           {startOf(batch.coveredFirst[k]),
                                                            startOf(batch.coveredLast[k] + 1)},
                                                           crossing & batch.rising,
                                                           crossing & batch.falling}
                                                 : RowRuns{all, {all.last, all.last}, crossing, 0};
            }
        }
        cost_.rowsVisited += static_cast<std::uint64_t>(foundCount);
        return foundCount;
    }

    // What is worth fetching at once: longer runs are fetched as they are read.
    static constexpr std::uint32_t kMostFetched = 128;
    static constexpr std::uint32_t kLine = 64;

    void fetchSlots(Run run) const {
        const std::uint32_t last = lowest(run.last, run.first + kMostFetched);
        for (std::uint32_t at = run.first; at < last; at += kLine / sizeof(*view_.level.slots)) {
            __builtin_prefetch(view_.level.slots + at);
        }
    }

    void fetchColumns(Run run, PlaneSet planes) const {
        const std::uint32_t last = lowest(run.last, run.first + kMostFetched);
        for (std::uint32_t at = run.first; at < last; at += kLine / sizeof(Scalar)) {
            for (PlaneSet left = planes; left != 0; left &= left - 1) {
                for (const Scalar* corner : view_.planes[firstPlane(left)].corner) {
                    __builtin_prefetch(corner + at);
                }
            }
        }
    }

    bool readRow(const RowRuns& row) {
        if (row.all.last - row.all.first <= WidePack<Scalar>::kWidth) {
            return scan<true>(row.all, row.before | row.behind, Row{});
        }
        return scan<true>({row.all.first, row.covered.first}, row.before, Row{}) &&
               take(row.covered) && scan<true>({row.covered.last, row.all.last}, row.behind, Row{});
    }

    // Where cells share buckets, nothing is known of what is read.
    [[gnu::noinline]] bool readHashed(const RowBatch<Scalar>& batch, int count) {
        for (int k = 0; k < count; ++k) {
            if (batch.first[k] <= batch.last[k]) {
                ++cost_.rowsVisited;
                if (!readHashedRow(batch, k)) {
                    return false;
                }
            }
        }
        return true;
    }

    bool readHashedRow(const RowBatch<Scalar>& batch, int k) {
        const LevelView<Scalar>& level = view_.level;
        const Row row = batch.rows[k];
        const std::uint32_t* starts = level.bucketStart;
        const auto length = static_cast<std::uint32_t>(batch.last[k] - batch.first[k]) + 1;
        const std::uint32_t bucket =
            rowBase(level, row) + static_cast<std::uint32_t>(batch.first[k]);
        const std::uint32_t first =
            length >= level.bucketCount ? 0 : bucket & (level.bucketCount - 1);
        const std::uint32_t end = first + lowest(length, level.bucketCount);
        const std::uint32_t wrapped = end > level.bucketCount ? end - level.bucketCount : 0;
        return scan<false>({starts[first], starts[lowest(end, level.bucketCount)]}, crossing_,
                           row) &&
               scan<false>({starts[0], starts[wrapped]}, crossing_, row);
    }

    // Once in memory, for all that call it: the first search of a frame has to fetch the code, too.
    template <bool kIsDense>
    [[gnu::noinline]] bool scan(Run run, PlaneSet planes, Row row) {
        using Pack = WidePack<Scalar>;
        constexpr std::uint32_t width = Pack::kWidth;
        cost_.boxesTested += run.last - run.first;
        for (std::uint32_t first = run.first; first < run.last; first += width) {
            if (static_cast<std::uint32_t>(found_.end - found_.next) < width &&
                !found_.flush(found_)) {
                return false;
            }
            std::uint32_t mask = laneMask(run.last - first, width);
            for (PlaneSet left = planes; left != 0 && mask != 0; left &= left - 1) {
                mask &= bitsOf<Pack>(view_.planes[firstPlane(left)], first);
            }
            const std::uint32_t* slots = view_.level.slots;
            if constexpr (kIsDense) {
                found_.next = writeNumbers<Pack>(mask, slots + first, found_.next);
                continue;
            }
            for (; mask != 0; mask &= mask - 1) {
                const std::uint32_t hit = first + static_cast<std::uint32_t>(__builtin_ctz(mask));
                *found_.next = slots[hit];
                found_.next += isInRow<kIsDense>(view_.level, hit, row) ? 1 : 0;
            }
        }
        return true;
    }

    // Bit k tells whether the plane has some of box first + k inside.
    template <class Pack>
    std::uint32_t bitsOf(const BoxPlane<Scalar>& plane, std::uint32_t first) const {
        auto sum = Pack::all(plane.offset);
        for (int axis = 0; axis < 3; ++axis) {
            sum = Pack::plus(sum, Pack::times(Pack::all(plane.slope[axis]),
                                              Pack::load(plane.corner[axis] + first)));
        }
        const std::uint32_t may = Pack::bits(Pack::notAbove(Pack::all(-plane.slack), sum));
        const std::uint32_t does = Pack::bits(Pack::notAbove(Pack::all(plane.slack), sum));
        return may == does ? may : may & exactBitsOf<Pack>(plane, first);
    }

    template <class Pack>
    [[gnu::noinline]] std::uint32_t exactBitsOf(const BoxPlane<Scalar>& plane,
                                                std::uint32_t first) const {
        auto sum = Pack::all(plane.offset);
        auto size = Pack::all(absolute(plane.offset));
        for (int axis = 0; axis < 3; ++axis) {
            const auto term =
                Pack::times(Pack::all(plane.slope[axis]), Pack::load(plane.corner[axis] + first));
            sum = Pack::plus(sum, term);
            size = Pack::plus(size, Pack::magnitude(term));
        }
        const auto least = Pack::times(Pack::all(-view_.volume.rounding), size);
        return Pack::bits(Pack::notAbove(least, sum));
    }

    const VolumeView<Scalar>& view_;
    PlaneSet crossing_;
    SlotSink& found_;
    KernelCost& cost_;
};

template <class Scalar>
bool walkRows(const VolumeView<Scalar>& view, PlaneSet crossing, CellInterval layers,
              CellInterval rowsOfAll, VolumeReader<Scalar>& reader) {
    RowBatch<Scalar> batch(view, crossing);
    for (std::int32_t z = layers.low; z <= layers.high; ++z) {
        CellInterval rows = rowsOfAll;
        if (rowsOfAll.count() > 1) {
            Hull<Scalar> layer = view.all;
            view.setCells(2, z, z, layer);
            rows = view.cellsOf(view.clip(layer, 1), 1);
        }
        for (std::int32_t y = rows.low; y <= rows.high; ++y) {
            if (batch.add(Row{y, z}) && !reader.readRows(batch)) {
                return false;
            }
        }
    }
    return reader.readRows(batch);
}

template <class Scalar>
bool walkVolume(const LevelView<Scalar>& level, const Volume<Scalar>& volume, SlotSink& found,
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
    if (layers.count() * rows.count() * kBoxesPerVolumeRow > all.last - all.first) {
        return reader.test(all);
    }
    return walkRows(view, crossing, layers, rows, reader);
}
