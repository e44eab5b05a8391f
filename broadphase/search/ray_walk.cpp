// SPDX-License-Identifier: Zlib

// On each level the ray is cut into parts along one axis, from near to far. What is filed in a cell reaches
// no farther than into the next one: so a part of the cells along that axis says which part of the ray may
// meet what is filed there, and that one, which cells along the other axes have to be read. No cell belongs
// to two parts, so that nothing is found twice.

#include <broadphase/search/ray_walk.hpp>

#include <broadphase/simd/kernels.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace hashphase::detail {
namespace {

using TakeNear = FunctionRef<double(std::span<const std::uint32_t>)>;

/// From t = first to t = last of a ray, along which it is from 0 to 1.
struct Stretch {
    double first;
    double last;
};

/// A ray as cells see it: so thick that no rounding, here or in the region's key(), lets it pass by what
/// key() finds.
template <class Scalar>
class ThickRay {
public:
    explicit ThickRay(const RayRegion<Scalar>& ray) {
        double sum = 0;  // NaN when a number is
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto i = static_cast<Eigen::Index>(axis);
            const auto a = static_cast<double>(ray.fatness().min()[i]);
            const auto b = static_cast<double>(ray.fatness().max()[i]);
            from_[axis] = static_cast<double>(ray.from()[i]);
            way_[axis] = static_cast<double>(ray.direction()[i]);
            const double reach =
                std::abs(from_[axis]) + 2 * std::abs(way_[axis]) + std::abs(a) + std::abs(b);
            const double padding = 16 * kEpsilon * reach + 4 * kTiny;
            low_[axis] = std::min(a, b) - padding;
            high_[axis] = std::max(a, b) + padding;
            sum += reach;
        }
        isExpressible_ = sum < 1 / kTiny;
    }

    /// Prepares part() for kernels; most rays that meet nothing need not.
    void aim() noexcept {
        for (std::size_t axis = 0; axis < 3 && !isAimed_; ++axis) {
            const double inverse = std::clamp(1 / way_[axis], -1 / kTiny, 1 / kTiny);
            part_.lowFrom[axis] = static_cast<Scalar>(from_[axis] + high_[axis]);
            part_.highFrom[axis] = static_cast<Scalar>(from_[axis] + low_[axis]);
            part_.inverse[axis] = static_cast<Scalar>(inverse);
        }
        isAimed_ = true;
    }

    /// False when a number is too large to be counted with, or NaN: then it may meet every box, and nothing else
    /// means anything.
    [[nodiscard]] bool isExpressible() const noexcept { return isExpressible_; }
    [[nodiscard]] double way(std::size_t axis) const noexcept { return way_[axis]; }
    /// What the region meets at `key` or sooner, the ray meets at this or sooner.
    [[nodiscard]] static double lastFor(double key) noexcept {
        return std::clamp(key + 16 * kEpsilon, -1.0, 1.0) * (1 + 16 * kEpsilon);
    }

    /// The part of `all` in which it may be between two coordinates [m] of an axis.
    [[nodiscard]] Stretch between(double lowest, double highest, std::size_t axis,
                                  Stretch all) const noexcept {
        if (way_[axis] == 0) {
            return all;
        }
        const double one = (lowest - high_[axis] - from_[axis]) / way_[axis];
        const double other = (highest - low_[axis] - from_[axis]) / way_[axis];
        return {std::max(all.first, std::min(one, other)),
                std::min(all.last, std::max(one, other))};
    }

    /// Sets the part's bounds to those of a stretch.
    void bound(Stretch stretch) noexcept {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double one = from_[axis] + stretch.first * way_[axis];
            const double other = from_[axis] + stretch.last * way_[axis];
            part_.bounds[axis] = static_cast<Scalar>(std::min(one, other) + low_[axis]);
            part_.bounds[axis + 3] = static_cast<Scalar>(std::max(one, other) + high_[axis]);
        }
    }
    [[nodiscard]] RayPart<Scalar>& part() noexcept { return part_; }

private:
    using Limits = std::numeric_limits<Scalar>;
    static constexpr auto kEpsilon = static_cast<double>(Limits::epsilon());
    // A way shorter than this counts as none: its inverse is a finite float, and the padding is more.
    static constexpr double kTiny = 1e-36;

    std::array<double, 3> from_;
    std::array<double, 3> way_;
    std::array<double, 3> low_;  // of what is moved, and the padding
    std::array<double, 3> high_;
    bool isExpressible_;
    bool isAimed_ = false;
    RayPart<Scalar> part_{};
};

/// A walk through the levels of a table.
template <class Scalar>
class RayWalk {
public:
    // Its 4 kB are written before they are read.
    // cppcheck-suppress uninitMemberVar
    RayWalk(const Table<Scalar>& table, const RayRegion<Scalar>& region, double limit,
            TakeNear take)
        : table_(table), region_(region), ray_(region), limit_(limit), take_(take) {}

    /// Returns false when it is to end.
    [[nodiscard]] bool walk(const Level<Scalar>& level) {
        if (!ray_.isExpressible()) {
            return offerAll(level);
        }
        const Stretch all{0, ray_.lastFor(limit_)};
        ray_.bound(all);
        if (!level.hasCells()) {
            return read(level, true, RayPart<Scalar>::kNoSieve);
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (!setCells(level, axis)) {
                return true;
            }
        }
        const Sieve flat = bestSieve(level, true);
        const Cut cut = cheapestCut(level, flat);
        if (cut.cost > kLeastSieved * level.count()) {
            const Sieve any = bestSieve(level, false);
            if (cut.cost > any.cost * level.count()) {
                return read(level, true, any.axis);
            }
        }
        return cut.count == 1 && holdsFew(level, cut) ? read(level, false, flat.axis)
                                                      : walkParts(level, cut);
    }

    KernelCost cost{};

private:
    struct Met {
        Scalar key;
        std::uint32_t proxyIndex;
    };

    /// An axis on which few boxes of long runs are near the ray: eight at once, or sixteen, are passed by if none
    /// is. With what it costs to test a box.
    struct Sieve {
        std::uint32_t axis;
        double cost;
    };

    /// The ray in `count` parts of so many cells along an axis, and what it costs to read them, in boxes tested.
    struct Cut {
        std::size_t axis;
        std::int32_t cells;
        std::int32_t count;
        double cost;
        double boxesOfPart;
        Sieve sieve;
    };

    // Cells of a part, at least: along x, where a row is read at a time, more.
    static constexpr std::array<std::int32_t, 3> kFewestCells{8, 2, 2};
    static constexpr std::int32_t kLonger = 4;
    // Of a part that has more cells: what is near is to be offered before what is far is read.
    static constexpr double kFewBoxes = 128;

    static constexpr double kLeastSieved = 0.25;

    [[nodiscard]] Sieve bestSieve(const Level<Scalar>& level, bool onlyFlat) noexcept {
        constexpr double kBoxesAtOnce = 16;
        const RayPart<Scalar>& part = ray_.part();
        Sieve best{RayPart<Scalar>::kNoSieve, 1};
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            const bool isFlat = level.inverseCellSize[axis] == 0;
            if (onlyFlat && !isFlat) {
                continue;
            }
            const double near = isFlat ? static_cast<double>(part.bounds[axis + 3] -
                                                             part.bounds[axis] + level.largestEdge)
                                       : double{2} + part.highCell[axis] - part.lowCell[axis];
            const double all = isFlat
                                   ? static_cast<double>(level.highest[axis] - level.lowest[axis])
                                   : double{1} + level.high[axis] - level.low[axis];
            if (kLeastSieved * all + kBoxesAtOnce * near < best.cost * all) {
                best = {axis, kLeastSieved + kBoxesAtOnce * near / all};
            }
        }
        return best;
    }

    // Sets the part's cells along an axis to those around its bounds. Returns whether there are any.
    [[nodiscard]] bool setCells(const Level<Scalar>& level, std::size_t axis) noexcept {
        RayPart<Scalar>& part = ray_.part();
        part.lowCell[axis] = std::max(level.cell(part.bounds[axis], axis) - 1, level.low[axis]);
        part.highCell[axis] = std::min(level.cell(part.bounds[axis + 3], axis), level.high[axis]);
        return part.lowCell[axis] <= part.highCell[axis];
    }

    // By how the ray slopes, without a look at what is filed in the cells: along the axis that has most parts,
    // in parts as long as pays where few boxes are.
    [[nodiscard]] Cut cheapestCut(const Level<Scalar>& level, const Sieve& sieve) noexcept {
        const RayPart<Scalar>& part = ray_.part();
        std::size_t axis = 0;
        for (std::size_t i = 1; i < 3; ++i) {
            const auto partsAlong = [&](std::size_t k) {
                return (part.highCell[k] - part.lowCell[k]) / kFewestCells[k];
            };
            axis = partsAlong(i) > partsAlong(axis) ? i : axis;
        }
        Cut best = cutAlong(level, axis, kFewestCells[axis], sieve);
        while (best.count > 1) {
            const Cut longer = cutAlong(level, axis, kLonger * best.cells, sieve);
            if (longer.cost >= best.cost || longer.boxesOfPart > kFewBoxes) {
                break;
            }
            best = longer;
        }
        return best;
    }

    [[nodiscard]] Cut cutAlong(const Level<Scalar>& level, std::size_t axis, std::int32_t cells,
                               const Sieve& sieve) noexcept {
        constexpr double kBoxesPerPart = 16;
        const auto extent = [&](std::size_t i) {
            return static_cast<double>(ray_.part().highCell[i] - ray_.part().lowCell[i]) + 1;
        };
        // Rows of a hashed level that are so long go through some buckets more than once.
        if (!level.isDense() && axis == 0 && extent(0) > level.bucketCount) {
            return {axis, cells, 1, std::numeric_limits<double>::infinity(), 0, sieve};
        }
        const std::int32_t count =
            (ray_.part().highCell[axis] - ray_.part().lowCell[axis]) / cells + 1;
        const double share = 1.0 / count;
        const auto extentOfPart = [&](std::size_t i) {
            return std::min(extent(i), i == axis ? cells : extent(i) * share + 2);
        };
        const double rows = extentOfPart(1) * extentOfPart(2);
        const double boxes =
            sieve.cost * rows * extentOfPart(0) * level.count() / level.bucketCount;
        const double costOfPart = kBoxesPerPart + rows * static_cast<double>(kBoxesPerRun) + boxes;
        return {axis, cells, count, count * costOfPart, boxes, sieve};
    }

    // Whether the part has no more cells than it must, or few boxes in them, but for those behind which a hashed row
    // wraps around.
    [[nodiscard]] bool holdsFew(const Level<Scalar>& level, const Cut& cut) noexcept {
        const RayPart<Scalar>& part = ray_.part();
        if (part.highCell[cut.axis] - part.lowCell[cut.axis] < kFewestCells[cut.axis]) {
            return true;
        }
        const std::uint32_t length =
            static_cast<std::uint32_t>(part.highCell[0] - part.lowCell[0]) + 1;
        std::uint32_t boxes = 0;
        for (std::int32_t z = part.lowCell[2]; z <= part.highCell[2]; ++z) {
            for (std::int32_t y = part.lowCell[1]; y <= part.highCell[1]; ++y) {
                const std::uint32_t first = level.bucket(part.lowCell[0], {y, z});
                const std::uint32_t end = std::min(first + length, level.bucketCount);
                boxes += level.bucketStart[end] - level.bucketStart[first];
            }
        }
        return boxes * cut.sieve.cost <= kFewBoxes;
    }

    [[nodiscard]] bool walkParts(const Level<Scalar>& level, const Cut& cut) {
        const std::size_t axis = cut.axis;
        const std::int32_t first = ray_.part().lowCell[axis];
        const std::int32_t last = ray_.part().highCell[axis];
        const double size = 1 / static_cast<double>(level.inverseCellSize[axis]);
        const auto origin = static_cast<double>(level.origin[axis]);
        const double farthest = std::max(std::abs(first), std::abs(last) + 2) * size;
        const double margin = 8 * static_cast<double>(std::numeric_limits<Scalar>::epsilon()) *
                              (std::abs(origin) + farthest + size);
        std::int32_t cells = cut.cells;
        for (std::int32_t left = last - first + 1; left > 0;) {
            const std::int32_t some = std::min(cells, left);
            const std::int32_t low = ray_.way(axis) < 0 ? first + left - some : last + 1 - left;
            const std::int32_t high = low + some - 1;
            const Stretch all{0, ray_.lastFor(limit_)};
            const Stretch part = ray_.between(origin + low * size - margin,
                                              origin + (high + 2.0) * size + margin, axis, all);
            if (part.first <= part.last) {
                ray_.bound(part);
                ray_.part().lowCell[axis] = low;
                ray_.part().highCell[axis] = high;
                const bool isEmpty =
                    !setCells(level, (axis + 1) % 3) || !setCells(level, (axis + 2) % 3);
                if (!isEmpty && !holdsFew(level, cut)) {
                    cells = std::max(some / kLonger, kFewestCells[axis]);
                    continue;
                }
                if (!isEmpty && !read(level, false, cut.sieve.axis)) {
                    return false;
                }
            }
            left -= some;
        }
        return true;
    }

    [[nodiscard]] bool read(const Level<Scalar>& level, bool readsAll, std::uint32_t sieve) {
        ray_.aim();
        ray_.part().sieve = sieve;
        ray_.part().last = static_cast<Scalar>(ray_.lastFor(limit_));
        PairSink sink{found_.data(), found_.data(), &grow, this};
        sink.end += found_.size();
        return kernels<Scalar>().queryRay(level, ray_.part(), readsAll, sink, cost) &&
               handOver(sink);
    }

    // Where numbers are too large for the kernel.
    [[nodiscard]] bool offerAll(const Level<Scalar>& level) {
        PairSink sink{found_.data(), found_.data(), &grow, this};
        cost.boxesTested += level.count();
        for (std::uint32_t entry = level.firstEntry; entry < level.lastEntry; ++entry) {
            if (sink.next == found_.data() + found_.size() && !handOver(sink)) {
                return false;
            }
            *sink.next++ = {0, entry};
        }
        return handOver(sink);
    }

    static bool grow(PairSink& sink, std::size_t /*count*/) {
        return static_cast<RayWalk*>(sink.owner)->handOver(sink);
    }

    [[nodiscard]] bool handOver(PairSink& sink) {
        const std::span<IndexPair> found(found_.data(), sink.next);
        sink.next = found_.data();
        const double last = ray_.lastFor(limit_);
        std::size_t count = 0;
        for (const IndexPair& pair : found) {
            const Scalar key = region_.key(table_.box(pair.b));
            met_[count] = {key, table_.proxyIndex(pair.b)};
            count += static_cast<double>(key) <= last ? 1 : 0;
        }
        if (count == 0) {
            return true;
        }
        std::ranges::sort(std::span(met_).first(count), {},
                          [](const Met& met) { return std::pair(met.key, met.proxyIndex); });
        for (std::size_t i = 0; i < count; ++i) {
            indices_[i] = met_[i].proxyIndex;
        }
        limit_ = take_({indices_.data(), count});
        return limit_ >= 0;
    }

    const Table<Scalar>& table_;
    const RayRegion<Scalar>& region_;
    ThickRay<Scalar> ray_;
    double limit_;
    TakeNear take_;
    std::array<IndexPair, kMostRoom> found_;
    std::array<Met, kMostRoom> met_;
    std::array<std::uint32_t, kMostRoom> indices_;
};

}  // namespace

template <class Scalar>
bool searchCells(const Table<Scalar>& table, const RayRegion<Scalar>& region, double limit,
                 TakeNear take, QueryCost& cost) {
    if (table.size() == 0 || region.isEmpty()) {
        return true;
    }
    if (!(limit >= 0)) {
        return false;
    }
    RayWalk<Scalar> search(table, region, limit, take);
    const bool goesOn = std::ranges::all_of(table.levels(), [&](const Level<Scalar>& level) {
        return level.count() == 0 || search.walk(level);
    });
    cost.rowsVisited += search.cost.rowsVisited;
    cost.boxesTested += search.cost.boxesTested;
    return goesOn;
}

template bool searchCells(const Table<float>&, const RayRegion<float>&, double, TakeNear,
                          QueryCost&);
template bool searchCells(const Table<double>&, const RayRegion<double>&, double, TakeNear,
                          QueryCost&);

}  // namespace hashphase::detail
