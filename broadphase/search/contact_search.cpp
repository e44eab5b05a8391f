// SPDX-License-Identifier: Zlib

// What sweeping proxies meet. Those that stand are found around segments of the way, each about as
// long as makes least work: boxes around longer ones hold more that is not met, and shorter ones
// take more searches. Those that sweep as well are found slice by slice of time: who touch each other
// do so in one slice. What is found so is then asked by firstContact().

#include <broadphase/search/contact_search.hpp>

#include <broadphase/core/ensure_capacity.hpp>
#include <broadphase/core/pair_key.hpp>
#include <broadphase/core/radix_sort.hpp>
#include <broadphase/geometry/padded_box.hpp>
#include <broadphase/search/join.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace hashphase::detail {
namespace {

// A way of more segments is rather looked for as a whole, as a ray.
constexpr int kMostSegments = 40;

// Measured in a uniform world, and in one as flat as a landscape; 4 and 6 do as well.
constexpr int kCellsPerSegment = 5;

constexpr int kMostSlices = 64;

// Extends the world by where the level's boxes are, and a little more: a cell may be one off, and more
// where its number has as many digits as a coordinate.
template <class Scalar>
void extendByCells(Aabb<double>& world, const Level<Scalar>& level) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Aabb<double> bounds;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto at = static_cast<Eigen::Index>(axis);
        const auto border = [&](std::int64_t cell, double outward) {
            const double far =
                static_cast<double>(cell) / static_cast<double>(level.inverseCellSize[axis]);
            const double doubt = 2 * static_cast<double>(std::numeric_limits<Scalar>::epsilon());
            return static_cast<double>(level.origin[axis]) + far + outward * doubt * std::abs(far);
        };
        if (level.inverseCellSize[axis] == 0) {
            bounds.min()[at] = static_cast<double>(level.lowest[axis]);
            bounds.max()[at] = static_cast<double>(level.highest[axis]);
            continue;
        }
        // In the last cells is whatever lies beyond.
        const std::int64_t low = level.low[axis];
        const std::int64_t high = level.high[axis];
        bounds.min()[at] = low <= -kCellLimit ? -kInfinity : border(low - 1, -1);
        bounds.max()[at] = high >= kCellLimit - 2 ? kInfinity : border(high + 3, 1);
    }
    world.extend(bounds);
}

// Extends the world by all boxes of the table.
template <class Scalar>
void extendByTable(Aabb<double>& world, const Table<Scalar>& table) {
    for (const Level<Scalar>& level : table.levels()) {
        if (level.count() > 0 && level.hasCells()) {
            extendByCells(world, level);
        }
        for (std::uint32_t i = level.firstEntry; i < level.lastEntry && !level.hasCells(); ++i) {
            const Aabb<Scalar> box = table.box(i);
            if (!hasNan(box)) {
                world.extend(box.template cast<double>());
            }
        }
    }
}

// Between which times a moving box may touch something in the world; from > to when never.
template <class Scalar>
Part partWithin(const MovingBox<Scalar>& moving, const Aabb<double>& world) {
    constexpr double kWidened = 1e-12;  // more than the rounding
    Part part;
    for (int axis = 0; axis < 3; ++axis) {
        const auto way = static_cast<double>(moving.displacement[axis]);
        const double first = world.min()[axis] - static_cast<double>(moving.box.max()[axis]);
        const double last = world.max()[axis] - static_cast<double>(moving.box.min()[axis]);
        if (std::isnan(first) || std::isnan(last)) {
            continue;  // both are infinite
        }
        if (way == 0) {
            part.to = first > 0 || last < 0 ? -1.0 : part.to;
            continue;
        }
        part.from = std::max(part.from, std::min(first / way, last / way) * (1 - kWidened));
        part.to = std::min(part.to, std::max(first / way, last / way) * (1 + kWidened));
    }
    return part;
}

// The moving box as kernels need it. An axis along which it hardly moves repeats another one: the
// boxes around its segments say all there is to say about it.
template <class Scalar>
SweptBox<Scalar> wayOf(const MovingBox<Scalar>& moving) {
    using Limits = std::numeric_limits<Scalar>;
    SweptBox<Scalar> way{};
    int far = 0;
    moving.displacement.cwiseAbs().maxCoeff(&far);
    const Vector3<Scalar> reach =
        moving.box.min().cwiseAbs() + moving.box.max().cwiseAbs() + moving.displacement.cwiseAbs();
    const bool isUsual = reach.maxCoeff() < Limits::max() / 8 &&
                         std::abs(moving.displacement[far]) > 8 * Limits::min();
    for (int k = 0; k < 3 && isUsual; ++k) {
        const bool moves = std::abs(moving.displacement[k]) > 8 * Limits::min();
        const int axis = moves ? k : far;
        const bool rises = moving.displacement[axis] > 0;
        const auto low = static_cast<std::uint32_t>(axis);
        const std::uint32_t high = low + 3;
        way.enterColumn[k] = rises ? low : high;
        way.enterFrom[k] = rises ? moving.box.max()[axis] : moving.box.min()[axis];
        way.leaveColumn[k] = rises ? high : low;
        way.leaveFrom[k] = rises ? moving.box.min()[axis] : moving.box.max()[axis];
        way.inverse[k] = 1 / moving.displacement[axis];
    }
    return way;
}

}  // namespace

template <class Scalar>
void ContactSearch<Scalar>::find(std::span<const Motion<Scalar>> motions, ParallelFor parallelFor) {
    motions_ = motions;
    cost_ = {};
    cost_.sweeping = static_cast<std::uint32_t>(motions_.size());
    contacts_.clear();
    if (motions_.empty()) {
        return;
    }
    touching_.clear();
    cutIntoSegments();
    meetStanding(parallelFor);
    meetStandingByRay(parallelFor);
    meetEachOther(parallelFor);
    const std::span<const IndexPair> touching = touching_.pairs();
    contacts_.resize(touching.size());
    std::transform(
        touching.begin(), touching.end(), contacts_.begin(),
        [](const IndexPair& proxyIndices) { return pairKey(proxyIndices.a, proxyIndices.b); });
    radixSort(contacts_, static_cast<std::uint32_t>(store_.proxies.records.size()), sorted_);
    contacts_.erase(std::unique(contacts_.begin(), contacts_.end()), contacts_.end());
}

template <class Scalar>
void ContactSearch<Scalar>::cutIntoSegments() {
    segments_.clear();
    motionOfSegment_.clear();
    ways_.clear();
    rays_.clear();
    Aabb<double> world;
    extendByTable(world, store_.tables.mobile);
    extendByTable(world, store_.tables.resting);
    const auto cellSize = static_cast<Scalar>(
        std::min(store_.tables.mobile.finestCellSize(), store_.tables.resting.finestCellSize()));
    for (std::uint32_t i = 0; i < motions_.size(); ++i) {
        ways_.push_back(wayOf(motions_[i].way));
        cut(i, world, cellSize);
    }
    cutFewRays();
    cost_.segments = segments_.size();
    cost_.rays = static_cast<std::uint32_t>(rays_.size());
}

// Beyond the world there is nothing to be met.
template <class Scalar>
void ContactSearch<Scalar>::cut(std::uint32_t motion, const Aabb<double>& world, Scalar cellSize) {
    const MovingBox<Scalar>& way = motions_[motion].way;
    const Part within = partWithin(way, world);
    if (within.from > within.to) {
        return;
    }
    const Point far = way.displacement.cwiseAbs();
    const Scalar length = kCellsPerSegment * std::max(cellSize, way.box.sizes().maxCoeff());
    // Along one axis the box around the way is the way. Along more, segments are a fifth faster in a cube of 30,000
    // boxes, and up to 3 % slower on flat ground; only where a few ways cross most of a small world is the box
    // faster by more, up to 16 %.
    const bool isThin = (far.array() > length).count() < 2;
    const Sweep sweep = motions_[motion].sweep;
    if (sweep == Sweep::box || (sweep == Sweep::automatic && isThin) || !(length > 0)) {
        addSegments(motion, way, within, 1);
        return;
    }
    const double count =
        std::ceil((within.to - within.from) * static_cast<double>(far.maxCoeff() / length));
    if (count <= kMostSegments) {
        addSegments(motion, way, within, std::max(1, static_cast<int>(count)));
    } else {
        rays_.push_back({motion, within, count});
    }
}

// Many rays after an update make a tree of all mobile boxes. For a few ways that is not worth it.
template <class Scalar>
void ContactSearch<Scalar>::cutFewRays() {
    constexpr double kBoxesPerSegment = 8;  // of a tree made in the time of a segment
    double count = 0;
    for (const LongSweep& ray : rays_) {
        count += ray.segments;
    }
    if (!(count * kBoxesPerSegment < static_cast<double>(store_.tables.mobile.size()))) {
        return;
    }
    for (const LongSweep& ray : rays_) {
        addSegments(ray.motion, motions_[ray.motion].way, ray.within,
                    static_cast<int>(ray.segments));
    }
    rays_.clear();
}

template <class Scalar>
void ContactSearch<Scalar>::addSegments(std::uint32_t motion, const MovingBox<Scalar>& way,
                                        const Part& part, int count) {
    double begin = part.from;
    for (int i = 1; i <= count; ++i) {
        const double end = i == count ? part.to : part.from + (part.to - part.from) * i / count;
        segments_.push(sweptBounds(way, begin, end));
        motionOfSegment_.push_back(motion);
        begin = end;
    }
}

// A few segments at a time: what is found around them is then still in
// the processor's cache.
template <class Scalar>
void ContactSearch<Scalar>::meetStanding(ParallelFor parallelFor) {
    constexpr std::size_t kAtOnce = 32;
    std::atomic<std::uint64_t> contactsTested{0};
    KernelCost cost;
    touchingNow_.clear();
    parts_.collect(
        parallelFor, segments_.size(), kAtOnce, touchingNow_, cost,
        [&](std::size_t first, std::size_t last, PairSink& sink, KernelCost& own) {
            FewPairs found;
            std::uint64_t tested = 0;
            for (; first < last; first += kAtOnce) {
                const std::size_t end = std::min(first + kAtOnce, last);
                for (const Table<Scalar>* table : {&store_.tables.mobile, &store_.tables.resting}) {
                    found.assign([&](PairSink& candidates) {
                        walkSegments(*table, first, end, candidates, own);
                    });
                    tested += found.pairs().size();
                    addTouching(*table, found.pairs(), sink);
                }
            }
            contactsTested += tested;
        });
    cost_.boxesTested += cost.boxesTested;
    cost_.contactsTested += contactsTested;
    touching_.append(touchingNow_.pairs());
}

template <class Scalar>
void ContactSearch<Scalar>::walkSegments(const Table<Scalar>& table, std::size_t first,
                                         std::size_t last, PairSink& candidates,
                                         KernelCost& cost) const {
    for (const Level<Scalar>& level : table.levels()) {
        if (level.count() > 0) {
            kernels<Scalar>().querySwept(level, segments_.columns().data(), ways_.data(),
                                         motionOfSegment_.data(), static_cast<std::uint32_t>(first),
                                         static_cast<std::uint32_t>(last), candidates, cost);
        }
    }
}

template <class Scalar>
void ContactSearch<Scalar>::addTouching(const Table<Scalar>& table,
                                        std::span<const IndexPair> candidates,
                                        PairSink& sink) const {
    for (const auto [segment, entry] : candidates) {
        const Motion<Scalar>& motion = motions_[motionOfSegment_[segment]];
        if (firstContact(motion.way, MovingBox<Scalar>{table.box(entry)})) {
            makeRoom(sink, 1);
            *sink.next++ = {motion.id.index, table.proxyIndex(entry)};
        }
    }
}

// Appends what stands in the table and is met by a ray.
template <class Scalar>
void ContactSearch<Scalar>::addMetByRay(const Reading<Scalar>& reading,
                                        const Filing<Scalar>& filing, const Motion<Scalar>& motion,
                                        PairSink& sink, QueryCost& cost) const {
    const MovingBoxRegion<Scalar> region(motion.way);
    const auto take = [&](std::span<const std::uint32_t> proxyIndices) {
        for (const std::uint32_t proxyIndex : proxyIndices) {
            if (store_.standsIn(filing, proxyIndex, reading) &&
                region.key(store_.proxies.records[proxyIndex].box) >= 0) {
                makeRoom(sink, 1);
                *sink.next++ = {motion.id.index, proxyIndex};
            }
        }
        return 1.0;
    };
    store_.searchAlong(region.segment(), *filing.table, 1.0, take, cost);
}

template <class Scalar>
void ContactSearch<Scalar>::meetStandingByRay(ParallelFor parallelFor) {
    constexpr std::size_t kGrain = 16;
    if (rays_.empty()) {
        return;
    }
    const Reading<Scalar> reading = store_.tables.reading();
    store_.growTrees(reading, rays_.size());
    KernelCost cost;
    touchingNow_.clear();
    parts_.collect(parallelFor, rays_.size(), kGrain, touchingNow_, cost,
                   [&](std::size_t first, std::size_t last, PairSink& sink, KernelCost& own) {
                       for (std::size_t i = first; i < last; ++i) {
                           const Motion<Scalar>& motion = motions_[rays_[i].motion];
                           QueryCost read;
                           for (const Filing<Scalar>& filing : reading.standing()) {
                               addMetByRay(reading, filing, motion, sink, read);
                           }
                           own.boxesTested += read.boxesTested;
                       }
                   });
    cost_.boxesTested += cost.boxesTested;
    touching_.append(touchingNow_.pairs());
}

// The value that a share of a sample of the motions stays below. A stray or a giant does not decide.
template <class Scalar>
template <class ValueOf>
double ContactSearch<Scalar>::quantile(double share, const ValueOf& valueOf) {
    constexpr std::size_t kSample = 64;
    sample_.clear();
    for (std::size_t i = 0; i < motions_.size(); i += motions_.size() / kSample + 1) {
        const auto value = static_cast<double>(valueOf(motions_[i].way));
        if (!std::isnan(value)) {
            sample_.push_back(value);
        }
    }
    if (sample_.empty()) {
        return 0;
    }
    const auto at = sample_.begin() +
                    static_cast<std::ptrdiff_t>(share * static_cast<double>(sample_.size() - 1));
    std::nth_element(sample_.begin(), at, sample_.end());
    return *at;
}

// So many that in one slice most proxies move no more than twice as far as the next one is away:
// measured, as the lengths of segments.
template <class Scalar>
int ContactSearch<Scalar>::sliceCount() {
    using Moving = MovingBox<Scalar>;
    const double size = quantile(0.5, [](const Moving& m) { return m.box.sizes().maxCoeff(); });
    const double way =
        quantile(0.75, [](const Moving& m) { return m.displacement.cwiseAbs().maxCoeff(); });
    double room = 1 / static_cast<double>(motions_.size());
    for (int axis = 0; axis < 3; ++axis) {
        const double low = quantile(0.125, [&](const Moving& m) { return m.box.min()[axis]; });
        const double high = quantile(0.875, [&](const Moving& m) { return m.box.max()[axis]; });
        room *= std::max((high - low) / 0.75, size);
    }
    const double apart = std::max(std::cbrt(room), size);
    const double slices = std::ceil(way / (2 * apart));
    return slices > 1 ? static_cast<int>(std::min<double>(slices, kMostSlices)) : 1;
}

template <class Scalar>
void ContactSearch<Scalar>::meetEachOther(ParallelFor parallelFor) {
    if (motions_.size() < 2) {
        return;
    }
    const int count = sliceCount();
    motionNumbers_.clear();
    for (std::uint32_t i = 0; i < motions_.size(); ++i) {
        motionNumbers_.push_back(i);
    }
    for (int slice = 0; slice < count; ++slice) {
        const double from = static_cast<double>(slice) / count;
        const double to = static_cast<double>(slice + 1) / count;
        slice_.clear();
        for (const Motion<Scalar>& motion : motions_) {
            slice_.push_back(padded(sweptBounds(motion.way, from, to)));
        }
        sliceTable_.build(motionNumbers_, slice_, {}, parallelFor);
        KernelCost cost;
        candidates_.clear();
        joinTable(sliceTable_, parallelFor, parts_, candidates_, cost);
        cost_.boxesTested += cost.boxesTested;
        cost_.contactsTested += candidates_.size();
        addMeeting(parallelFor);
    }
}

template <class Scalar>
void ContactSearch<Scalar>::addMeeting(ParallelFor parallelFor) {
    constexpr std::size_t kGrain = 1024;
    KernelCost none;
    touchingNow_.clear();
    parts_.collect(parallelFor, candidates_.size(), kGrain, touchingNow_, none,
                   [&](std::size_t first, std::size_t last, PairSink& sink, KernelCost&) {
                       makeRoom(sink, last - first);
                       for (const auto [i, j] : candidates_.pairs().subspan(first, last - first)) {
                           const Motion<Scalar>& a = motions_[sliceTable_.proxyIndex(i)];
                           const Motion<Scalar>& b = motions_[sliceTable_.proxyIndex(j)];
                           if (firstContact(a.way, b.way)) {
                               *sink.next++ = {a.id.index, b.id.index};
                           }
                       }
                   });
    touching_.append(touchingNow_.pairs());
}

template <class Scalar>
void ContactSearch<Scalar>::releaseUnusedMemory() noexcept {
    freeArrays(contacts_, ways_, motionOfSegment_, rays_, sample_, sorted_, motionNumbers_, slice_);
    segments_ = {};
    parts_ = {};
    candidates_ = {};
    touchingNow_ = {};
    touching_ = {};
    sliceTable_ = {};
}

template <class Scalar>
std::size_t ContactSearch<Scalar>::memoryBytes() const noexcept {
    return (contacts_.capacity() + sorted_.capacity()) * sizeof(std::uint64_t) +
           (motionOfSegment_.capacity() + motionNumbers_.capacity()) * sizeof(std::uint32_t) +
           rays_.capacity() * sizeof(LongSweep) + sample_.capacity() * sizeof(double) +
           segments_.memoryBytes() + ways_.capacity() * sizeof(SweptBox<Scalar>) +
           parts_.memoryBytes() + candidates_.memoryBytes() + touchingNow_.memoryBytes() +
           touching_.memoryBytes() + slice_.capacity() * sizeof(PaddedBox<Scalar>) +
           sliceTable_.memoryBytes();
}

template class ContactSearch<float>;
template class ContactSearch<double>;

}  // namespace hashphase::detail
