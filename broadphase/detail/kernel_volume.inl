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

/// Numbers of planes.
struct PlaneSet {
    std::uint8_t numbers[kMostVolumePlanes];
    std::uint32_t count = 0;

    void add(std::uint32_t number) { numbers[count++] = static_cast<std::uint8_t>(number); }
};

// Writes first + k for every bit k; may write up to the width of a Pack. Returns where the next one goes.
template <class Pack>
std::uint32_t* writeBits(std::uint32_t mask, std::uint32_t first, std::uint32_t* next) {
    if constexpr (requires { Pack::compress(mask, first, next); }) {
        Pack::compress(mask, first, next);
        return next + __builtin_popcount(mask);
    } else {
        for (; mask != 0; mask &= mask - 1) {
            *next++ = first + static_cast<std::uint32_t>(__builtin_ctz(mask));
        }
        return next;
    }
}

#include <broadphase/detail/kernel_volume_rows.inl>

/// Reads the entries of a level that are in a volume.
template <class Scalar>
class VolumeReader {
public:
    /// `crossing` are the planes that may part the boxes of the level.
    VolumeReader(const VolumeView<Scalar>& view, const PlaneSet& crossing, EntrySink& found,
                 KernelCost& cost)
        : view_(view), crossing_(crossing), found_(found), cost_(cost) {}

    /// Tests a run. Returns, as all members do, false when the search is to end.
    bool test(Run run) { return scan<true>(run, crossing_, Row{}); }

    /// Takes a run without a test.
    bool take(Run run) {
        while (run.first < run.last) {
            const auto room = static_cast<std::uint32_t>(found_.end - found_.next);
            const std::uint32_t count = lowest(run.last - run.first, room);
            for (std::uint32_t k = 0; k < count; ++k) {
                found_.next[k] = run.first + k;
            }
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
        Run runs[kRowsAtOnce];
        Run covered[kRowsAtOnce];
        if (view_.level.isDense) {
            findRuns(batch, runs, covered);
        }
        for (int k = 0; k < batch.count; ++k) {
            if (batch.first[k] > batch.last[k]) {
                continue;
            }
            ++cost_.rowsVisited;
            const bool goesOn = view_.level.isDense
                                    ? readDense(batch.crossing[k], runs[k], covered[k])
                                    : readHashed(batch, k);
            if (!goesOn) {
                return false;
            }
        }
        batch.count = 0;
        return true;
    }

private:
    // The entries of each row, and those among them that are covered. What is to be tested is fetched
    // from memory for all rows at once.
    void findRuns(const RowBatch<Scalar>& batch, Run* runs, Run* covered) const {
        const LevelView<Scalar>& level = view_.level;
        for (int k = 0; k < batch.count; ++k) {
            const std::uint32_t* starts = level.bucketStart;
            const std::uint32_t base = rowBase(level, batch.rows[k]);
            const auto startOf = [starts, base](std::int32_t cell) {
                return starts[base + static_cast<std::uint32_t>(cell)];
            };
            const bool hasCells = batch.first[k] <= batch.last[k];
            const bool hasCovered = hasCells && batch.coveredFirst[k] <= batch.coveredLast[k];
            runs[k] = hasCells ? Run{startOf(batch.first[k]), startOf(batch.last[k] + 1)} : Run{};
            covered[k] =
                hasCovered ? Run{startOf(batch.coveredFirst[k]), startOf(batch.coveredLast[k] + 1)}
                           : Run{runs[k].last, runs[k].last};
        }
        for (int k = 0; k < batch.count; ++k) {
            for (int column = 0; column < 6 && batch.crossing[k] != 0; ++column) {
                __builtin_prefetch(level.columns[column] + runs[k].first);
                __builtin_prefetch(level.columns[column] + covered[k].last);
            }
        }
    }

    bool readDense(std::uint64_t crossing, Run all, Run covered) {
        PlaneSet planes;
        for (; crossing != 0; crossing &= crossing - 1) {
            planes.add(crossing_.numbers[__builtin_ctzll(crossing)]);
        }
        if (planes.count == 0) {
            return take(all);
        }
        constexpr std::uint32_t few = 2 * WidePack<Scalar>::kWidth;
        if (all.last - all.first <= few || covered.first == covered.last) {
            return scan<true>(all, planes, Row{});
        }
        return scan<true>({all.first, covered.first}, planes, Row{}) && take(covered) &&
               scan<true>({covered.last, all.last}, planes, Row{});
    }

    // Where cells share buckets, nothing is known of what is read.
    bool readHashed(const RowBatch<Scalar>& batch, int k) {
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

    template <bool kIsDense>
    bool scan(Run run, const PlaneSet& planes, Row row) {
        using Pack = WidePack<Scalar>;
        constexpr std::uint32_t width = Pack::kWidth;
        cost_.boxesTested += run.last - run.first;
        for (std::uint32_t first = run.first; first < run.last; first += width) {
            if (static_cast<std::uint32_t>(found_.end - found_.next) < width &&
                !found_.flush(found_)) {
                return false;
            }
            std::uint32_t mask = laneMask(run.last - first, width);
            for (std::uint32_t k = 0; k < planes.count && mask != 0; ++k) {
                mask &= bitsOf<Pack>(view_.planes[planes.numbers[k]], first);
            }
            if constexpr (kIsDense) {
                found_.next = writeBits<Pack>(mask, first, found_.next);
                continue;
            }
            for (; mask != 0; mask &= mask - 1) {
                const std::uint32_t hit = first + static_cast<std::uint32_t>(__builtin_ctz(mask));
                *found_.next = hit;
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
    const PlaneSet& crossing_;
    EntrySink& found_;
    KernelCost& cost_;
};

template <class Scalar>
bool walkRows(const VolumeView<Scalar>& view, const PlaneSet& crossing, CellInterval layers,
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
bool walkVolume(const LevelView<Scalar>& level, const Volume<Scalar>& volume, EntrySink& found,
                KernelCost& cost) {
    const VolumeView<Scalar> view(level, volume);
    PlaneSet crossing;
    for (std::uint32_t i = 0; i < volume.planeCount; ++i) {
        const Interval<Scalar> sum = view.sumOver(view.planes[i], view.all);
        if (sum.high < 0) {
            return true;
        }
        if (!(sum.low >= 0)) {
            crossing.add(i);
        }
    }
    VolumeReader<Scalar> reader(view, crossing, found, cost);
    const Run all = {level.firstEntry, level.lastEntry};
    if (crossing.count == 0) {
        return reader.take(all);
    }
    const CellInterval layers = view.cellsOf(view.clip(view.all, 2), 2);
    const CellInterval rows = view.cellsOf(view.clip(view.all, 1), 1);
    if (layers.count() * rows.count() * kBoxesPerVolumeRow > all.last - all.first) {
        return reader.test(all);
    }
    return walkRows(view, crossing, layers, rows, reader);
}
