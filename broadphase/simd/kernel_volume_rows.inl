// SPDX-License-Identifier: Zlib

// Kernel part: clips rows of cells by a convex volume. See kernel_volume.inl.

// Rows that are clipped at a time; the loops over them are made for vector instructions.
constexpr int kRowsAtOnce = 16;

/// Rows of cells, and of each of them the cells that the volume's own planes leave.
template <class Scalar>
class RowBatch {
public:
    int count = 0;
    Row rows[kRowsAtOnce];

    // Of each row the cells in which boxes may touch the volume, and those of them whose boxes surely
    // do; none where the first lies behind the last.
    std::int32_t first[kRowsAtOnce];
    std::int32_t last[kRowsAtOnce];
    std::int32_t coveredFirst[kRowsAtOnce];
    std::int32_t coveredLast[kRowsAtOnce];
    PlaneSet crossing[kRowsAtOnce];  // may part the boxes in the cells
    PlaneSet rising = 0;             // have more of a later cell inside than of an earlier one
    PlaneSet falling = 0;            // less

    /// By `planes`, all that may part the boxes of the level. What add() and clip() write is left as it
    /// is: most batches are short.
    // cppcheck-suppress uninitMemberVar
    RowBatch(const VolumeView<Scalar>& view, PlaneSet planes) : view_(view), planes_(planes) {
        for (PlaneSet left = planes; left != 0; left &= left - 1) {
            const std::uint32_t i = firstPlane(left);
            const Scalar slope = view.planes[i].slope[0];
            rising |= PlaneSet{slope > 0} << i;
            falling |= PlaneSet{slope < 0} << i;
        }
        for (int k = 0; k < kRowsAtOnce; ++k) {
            lowY_[k] = highY_[k] = lowZ_[k] = highZ_[k] = 0;
        }
    }

    /// Adds a row; true when the batch is full.
    bool add(Row row) {
        Hull<Scalar> hull = view_.all;
        view_.setCells(1, row.y, row.y, hull);
        view_.setCells(2, row.z, row.z, hull);
        rows[count] = row;
        lowY_[count] = hull.low[1];
        highY_[count] = hull.high[1];
        lowZ_[count] = hull.low[2];
        highZ_[count] = hull.high[2];
        return ++count == kRowsAtOnce;
    }

    /// Finds the cells of the rows.
    void clip() {
        Scalar least[kMostVolumePlanes][kRowsAtOnce];  // of each plane's sum, but for x
        Spans spans;
        clipRows(spans, least);
        if (view_.isFlat[0]) {
            findCell(spans);
        } else {
            findCells(spans);
        }
        findCrossings(least);
    }

    /// Clips the rows, and returns how many cells they have.
    std::uint64_t countCells() {
        clip();
        std::uint64_t cells = 0;
        for (int k = 0; k < count; ++k) {
            cells += first[k] <= last[k] ? static_cast<std::uint64_t>(last[k] - first[k]) + 1 : 0;
        }
        return cells;
    }

private:
    static constexpr auto kNowhere = -std::numeric_limits<Scalar>::infinity();

    /// Of each row, between which coordinates boxes may touch the volume, and between which they
    /// surely do.
    struct Spans {
        Scalar touchedLow[kRowsAtOnce];
        Scalar touchedHigh[kRowsAtOnce];
        Scalar coveredLow[kRowsAtOnce];
        Scalar coveredHigh[kRowsAtOnce];
    };

    void clipRows(Spans& spans, Scalar (*least)[kRowsAtOnce]) const {
        for (int k = 0; k < kRowsAtOnce; ++k) {
            spans.touchedLow[k] = spans.coveredLow[k] = view_.all.low[0];
            spans.touchedHigh[k] = spans.coveredHigh[k] = view_.all.high[0];
        }
        for (PlaneSet left = planes_; left != 0; left &= left - 1) {
            const std::uint32_t i = firstPlane(left);
            Scalar most[kRowsAtOnce];
            sumUp(view_.planes[i], least[i], most);
            narrow(spans, view_.planes[i].slope[0], least[i], most);
        }
    }

    // The plane's sum over the boxes of each row, but for x.
    void sumUp(const BoxPlane<Scalar> plane, Scalar* least, Scalar* most) const {
        for (int k = 0; k < kRowsAtOnce; ++k) {
            const Scalar atLowY = plane.slope[1] * lowY_[k];
            const Scalar atHighY = plane.slope[1] * highY_[k];
            const Scalar atLowZ = plane.slope[2] * lowZ_[k];
            const Scalar atHighZ = plane.slope[2] * highZ_[k];
            most[k] =
                (plane.offset + plane.slack) + larger(atLowY, atHighY) + larger(atLowZ, atHighZ);
            least[k] =
                (plane.offset - plane.slack) + smaller(atLowY, atHighY) + smaller(atLowZ, atHighZ);
        }
    }

    static void narrow(Spans& spans, Scalar slope, const Scalar* least, const Scalar* most) {
        const Scalar minusInverse = slope == 0 ? Scalar(0) : -1 / slope;
        if (slope > 0) {
            for (int k = 0; k < kRowsAtOnce; ++k) {
                spans.touchedLow[k] = larger(spans.touchedLow[k], most[k] * minusInverse);
                spans.coveredLow[k] = larger(spans.coveredLow[k], least[k] * minusInverse);
            }
        } else if (slope < 0) {
            for (int k = 0; k < kRowsAtOnce; ++k) {
                spans.touchedHigh[k] = smaller(spans.touchedHigh[k], most[k] * minusInverse);
                spans.coveredHigh[k] = smaller(spans.coveredHigh[k], least[k] * minusInverse);
            }
        } else {
            for (int k = 0; k < kRowsAtOnce; ++k) {
                spans.touchedHigh[k] = most[k] < 0 ? kNowhere : spans.touchedHigh[k];
                spans.coveredHigh[k] = least[k] < 0 ? kNowhere : spans.coveredHigh[k];
            }
        }
    }

    // Where the level is flat along x, a row is one cell.
    void findCell(const Spans& spans) {
        for (int k = 0; k < kRowsAtOnce; ++k) {
            const bool isCovered = spans.coveredLow[k] <= view_.all.low[0] &&
                                   spans.coveredHigh[k] >= view_.all.high[0];
            first[k] = coveredFirst[k] = 0;
            last[k] = spans.touchedLow[k] <= spans.touchedHigh[k] ? 0 : -1;
            coveredLast[k] = isCovered ? 0 : -1;
        }
    }

    void findCells(const Spans& spans) {
        quantiseAll(spans.touchedLow, first);
        quantiseAll(spans.touchedHigh, last);
        quantiseAll(spans.coveredLow, coveredFirst);
        quantiseAll(spans.coveredHigh, coveredLast);
        // Not read anew in each turn, as members would be that what is written might be a part of.
        const std::int32_t lowest = view_.level.low[0];
        const std::int32_t highest = view_.level.high[0];
        const Scalar begin = view_.all.low[0];
        const Scalar end = view_.all.high[0];
        for (int k = 0; k < kRowsAtOnce; ++k) {
            const std::int32_t low = larger(first[k] - 1, lowest);
            const std::int32_t high = smaller(last[k], highest);
            // What begins in a later cell than a number begins behind it; what begins two cells
            // before ends before it.
            const std::int32_t innerLow = larger(coveredFirst[k] + 1, low);
            const std::int32_t innerHigh = smaller(coveredLast[k] - 2, high);
            first[k] = low;
            last[k] = spans.touchedLow[k] <= spans.touchedHigh[k] ? high : low - 1;
            coveredFirst[k] = spans.coveredLow[k] <= begin ? low : innerLow;
            coveredLast[k] = spans.coveredHigh[k] >= end ? high : innerHigh;
        }
    }

    void quantiseAll(const Scalar* x, std::int32_t* cells) const {
        const Scalar origin = view_.level.origin[0];
        const Scalar inverse = view_.level.inverseCellSize[0];
        for (int k = 0; k < kRowsAtOnce; ++k) {
            cells[k] = quantise(x[k], origin, inverse);
        }
    }

    void findCrossings(const Scalar (*least)[kRowsAtOnce]) {
        Scalar low[kRowsAtOnce];
        Scalar high[kRowsAtOnce];
        for (int k = 0; k < kRowsAtOnce; ++k) {
            low[k] = view_.isFlat[0] ? view_.all.low[0] : view_.beginOf(first[k], 0);
            high[k] = view_.isFlat[0] ? view_.all.high[0] : view_.endOf(last[k], 0);
            crossing[k] = 0;
        }
        for (PlaneSet left = planes_; left != 0; left &= left - 1) {
            const std::uint32_t i = firstPlane(left);
            const Scalar slope = view_.planes[i].slope[0];
            const Scalar* const end = slope > 0 ? low : high;
            for (int k = 0; k < kRowsAtOnce; ++k) {
                const Scalar sum = least[i][k] + slope * end[k];
                crossing[k] |= PlaneSet{sum >= 0 ? 0U : 1U} << i;
            }
        }
    }

    const VolumeView<Scalar>& view_;
    PlaneSet planes_;
    Scalar lowY_[kRowsAtOnce];
    Scalar highY_[kRowsAtOnce];
    Scalar lowZ_[kRowsAtOnce];
    Scalar highZ_[kRowsAtOnce];
};
