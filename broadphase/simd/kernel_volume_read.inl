// SPDX-License-Identifier: Zlib

// Kernel part: reads the entries of a level that are in a convex volume. See kernel_volume.inl.

/// Lists the indices of a level's entries that are in a volume.
template <class Scalar>
class VolumeReader {
public:
    /// `crossing` are the planes that may part the boxes of the level.
    VolumeReader(const VolumeView<Scalar>& view, PlaneSet crossing, IndexSink& found,
                 KernelCost& cost)
        : view_(view), crossing_(crossing), found_(found), cost_(cost) {}

    /// Tests a run. Returns, as all members do, false when the search is to end.
    bool test(Run run) { return scan<true>(run, crossing_, Row{}); }

    /// Takes a run without a test.
    [[HASHPHASE_NO_INLINE]] bool take(Run run) {
        while (run.first < run.last) {
            const auto room = static_cast<std::uint32_t>(found_.end - found_.next);
            const std::uint32_t count = lowest(run.last - run.first, room);
            std::memcpy(found_.next, view_.level.proxyIndices + run.first,
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
        return view_.level.isDense() ? readDense(batch, count) : readHashed(batch, count);
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
            fetchIndices(rows[k].all);
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
            const std::uint32_t base = view_.level.template bucketOf<true>(0, batch.rows[k]);
            const auto startOf = [starts, base](std::int32_t cell) {
                return starts[base + static_cast<std::uint32_t>(cell)];
            };
            if (batch.first[k] > batch.last[k]) {
                continue;
            }
            RowRuns& row = found[foundCount++];
            row.all = {startOf(batch.first[k]), startOf(batch.last[k] + 1)};
            row.covered = {row.all.last, row.all.last};
            row.before = batch.crossing[k];
            row.behind = 0;
            if (batch.coveredFirst[k] <= batch.coveredLast[k]) {
                // A falling plane that has all of the covered cells inside has all before them inside,
                // too: only rising ones may part those, and only falling ones those behind. Planes
                // along y and z that part a row leave none of it covered.
                row.covered = {startOf(batch.coveredFirst[k]), startOf(batch.coveredLast[k] + 1)};
                row.before = batch.crossing[k] & batch.rising;
                row.behind = batch.crossing[k] & batch.falling;
            }
        }
        cost_.rowsVisited += static_cast<std::uint64_t>(foundCount);
        return foundCount;
    }

    // What is worth fetching at once: longer runs are fetched as they are read.
    static constexpr std::uint32_t kMostFetched = 128;
    static constexpr std::uint32_t kLine = 64;

    void fetchIndices(Run run) const {
        const std::uint32_t last = lowest(run.last, run.first + kMostFetched);
        for (std::uint32_t at = run.first; at < last;
             at += kLine / sizeof(*view_.level.proxyIndices)) {
            prefetch(view_.level.proxyIndices + at);
        }
    }

    void fetchColumns(Run run, PlaneSet planes) const {
        const std::uint32_t last = lowest(run.last, run.first + kMostFetched);
        for (std::uint32_t at = run.first; at < last; at += kLine / sizeof(Scalar)) {
            for (PlaneSet left = planes; left != 0; left &= left - 1) {
                for (const Scalar* corner : view_.planes[firstPlane(left)].corner) {
                    prefetch(corner + at);
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
    [[HASHPHASE_NO_INLINE]] bool readHashed(const RowBatch<Scalar>& batch, int count) {
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
        const Level<Scalar>& level = view_.level;
        const Row row = batch.rows[k];
        const auto length = static_cast<std::uint32_t>(batch.last[k] - batch.first[k]) + 1;
        const auto buckets = bucketsOf<false>(level, row, batch.first[k], length);
        return scan<false>(buckets.run(level), crossing_, row) &&
               scan<false>(buckets.wrapped(level), crossing_, row);
    }

    // Once in memory, for all that call it: the first search of a frame has to fetch the code, too.
    template <bool kIsDense>
    [[HASHPHASE_NO_INLINE]] bool scan(Run run, PlaneSet planes, Row row) {
        using Pack = WidePack<Scalar>;
        constexpr std::uint32_t width = Pack::kWidth;
        cost_.boxesTested += planes == 0 ? 0 : run.last - run.first;
        for (std::uint32_t first = run.first; first < run.last; first += width) {
            if (static_cast<std::uint32_t>(found_.end - found_.next) < width &&
                !found_.flush(found_)) {
                return false;
            }
            std::uint32_t mask = laneMask(run.last - first, width);
            for (PlaneSet left = planes; left != 0 && mask != 0; left &= left - 1) {
                mask &= bitsOf<Pack>(view_.planes[firstPlane(left)], first);
            }
            const std::uint32_t* proxyIndices = view_.level.proxyIndices;
            if constexpr (kIsDense) {
                found_.next = writeNumbers<Pack>(mask, proxyIndices + first, found_.next);
            } else {
                for (; mask != 0; mask &= mask - 1) {
                    const std::uint32_t hit = first + lowestBit(mask);
                    *found_.next = proxyIndices[hit];
                    found_.next += isInRow<false>(view_.level, hit, row) ? 1 : 0;
                }
            }
        }
        return true;
    }

    // Bit k tells whether the plane has some of box first + k inside.
    template <class Pack>
    [[nodiscard]] std::uint32_t bitsOf(const BoxPlane<Scalar>& plane, std::uint32_t first) const {
        auto sum = Pack::broadcast(plane.offset);
        for (int axis = 0; axis < 3; ++axis) {
            sum = Pack::plus(sum, Pack::times(Pack::broadcast(plane.slope[axis]),
                                              Pack::load(plane.corner[axis] + first)));
        }
        const std::uint32_t may = Pack::bits(Pack::lessEqual(Pack::broadcast(-plane.slack), sum));
        const std::uint32_t does = Pack::bits(Pack::lessEqual(Pack::broadcast(plane.slack), sum));
        return may == does ? may : may & exactBitsOf<Pack>(plane, first);
    }

    template <class Pack>
    [[nodiscard, HASHPHASE_NO_INLINE]] std::uint32_t exactBitsOf(const BoxPlane<Scalar>& plane,
                                                                 std::uint32_t first) const {
        auto sum = Pack::broadcast(plane.offset);
        auto size = Pack::broadcast(absolute(plane.offset));
        for (int axis = 0; axis < 3; ++axis) {
            const auto term = Pack::times(Pack::broadcast(plane.slope[axis]),
                                          Pack::load(plane.corner[axis] + first));
            sum = Pack::plus(sum, term);
            size = Pack::plus(size, Pack::abs(term));
        }
        const auto least = Pack::times(Pack::broadcast(-view_.volume.rounding), size);
        return Pack::bits(Pack::lessEqual(least, sum));
    }

    const VolumeView<Scalar>& view_;
    PlaneSet crossing_;
    IndexSink& found_;
    KernelCost& cost_;
};
