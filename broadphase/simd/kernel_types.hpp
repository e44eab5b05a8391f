// SPDX-License-Identifier: Zlib
#pragma once

// What kernels read and write: plain arrays and nothing that has code. Kernels are compiled for
// several instruction sets, and an inline function of the standard library that such a file emits
// could be the copy that the linker keeps for the whole program.

#include <broadphase/core/compiler.hpp>
#include <broadphase/hash/level.hpp>
#include <broadphase/proxy_groups.hpp>
#include <broadphase/simd/ray_types.hpp>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

namespace hashphase::detail {

/// Columns are readable this many entries past the last one.
inline constexpr std::uint32_t kColumnPadding = 16;

/// Looking up a run of buckets costs about as much as testing this many boxes one after another.
inline constexpr std::uint64_t kBoxesPerRun = 4;

/// A box of which each corner fills a vector register; the fourth numbers are 0.
template <class Scalar>
struct alignas(4 * sizeof(Scalar)) PaddedBox {
    Scalar low[4];
    Scalar high[4];
};

/// True when any of the six coordinates is NaN.
template <class Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline bool isNan(const PaddedBox<Scalar>& box) noexcept {
    bool result = false;
    for (int axis = 0; axis < 3; ++axis) {
        result |= isNan(box.low[axis]);
        result |= isNan(box.high[axis]);
    }
    return result;
}

/// Two entries whose boxes overlap, or two numbers of whatever else was asked about.
struct IndexPair {
    std::uint32_t a;
    std::uint32_t b;

    friend bool operator==(const IndexPair&, const IndexPair&) = default;
};

/// Kernels ask for room for so many pairs at a time, at most.
inline constexpr std::uint32_t kMostRoom = 256;

/// Where a kernel writes pairs: grow(sink, count) makes room for at least `count` behind `next`;
/// false ends the search.
struct PairSink {
    IndexPair* next;
    IndexPair* end;
    bool (*grow)(PairSink& sink, std::size_t count);
    void* owner;
};

/// Room for `count` more pairs; false ends the search.
[[HASHPHASE_ALWAYS_INLINE]] inline bool makeRoom(PairSink& sink, std::size_t count) {
    return static_cast<std::size_t>(sink.end - sink.next) >= count || sink.grow(sink, count);
}

/// Where a kernel writes indices: flush(sink) takes those up to `next` away and makes room for at least
/// 16; false ends the search.
struct IndexSink {
    std::uint32_t* begin;
    std::uint32_t* next;
    std::uint32_t* end;
    bool (*flush)(IndexSink& sink);
    void* owner;
};

inline constexpr std::uint32_t kMostOwnPlanes = 16;
inline constexpr std::uint32_t kMostVolumePlanes = 64;

/// A convex volume: the points p with slope . p + offset >= 0 for each plane. A box touches the volume
/// unless a plane has all of it outside, or is inside unless a plane has a corner of it outside; less
/// than `rounding` of the size of the sum's terms outside is not outside. Some planes may be there
/// only to bound it as boxes see it: across the axes, and along one or two of them.
template <class Scalar>
struct Volume {
    Scalar slope[3][kMostVolumePlanes];
    Scalar offset[kMostVolumePlanes];
    Scalar rounding;
    Scalar tiny;  // the least number of which no bit is lost
    std::uint32_t planeCount;
    bool isInside;
};

/// A box on its way through others: with what it passes on three axes, and when, in a unit of time.
/// On axis k it reaches a box when (columns[enterColumn[k]] - enterFrom[k]) * inverse[k] units have
/// passed, and leaves it behind by leaveColumn and leaveFrom. Where `inverse` is 0, always.
template <class Scalar>
struct SweptBox {
    Scalar enterFrom[3];
    Scalar leaveFrom[3];
    Scalar inverse[3];
    std::uint32_t enterColumn[3];
    std::uint32_t leaveColumn[3];
};

/// Who may pair with whom, for searches that are to find no others.
struct GroupsView {
    const ProxyGroups* groups;          // of an index: groups[2 * index]
    const std::uint32_t* indexOfQuery;  // by the number of what is looked for
    ProxyGroups together;               // all bits of those that are looked through
};

/// What a kernel did.
struct KernelCost {
    std::uint64_t rowsVisited = 0;
    std::uint64_t boxesTested = 0;

    KernelCost& operator+=(const KernelCost& other) noexcept {
        rowsVisited += other.rowsVisited;
        boxesTested += other.boxesTested;
        return *this;
    }
};

/// In the place of the bucket of a box that is not filed, because it has a NaN.
inline constexpr std::uint32_t kNoBucket = ~std::uint32_t{0};

/// Agents sorted by the cells of a wrapped grid (see wrapped_grid.hpp), as plain arrays, and what they look for.
template <class Scalar>
struct RadiusView {
    const Scalar* columns[3];  // positions, by axis; of two axes, what is the same along the third
    int axisCount;             // columns that are to be compared: two or three
    const std::uint32_t* numbers;    // 0, 1, 2 ...
    const std::uint32_t* cellStart;  // the first agent of each cell, and the end
    std::uint32_t extent[3];
    std::uint32_t reach;
    Scalar scale;  // of distances before they are squared; if it is not 1, there are three axes
    Scalar mostSquared;  // of scaled distances; negative: nobody is near
};

/// Where a kernel keeps the candidates of a cell's agents, and what it finds: grow(tile, count)
/// makes room for `count` candidates.
template <class Scalar>
struct RadiusTile {
    Scalar* columns[3];
    std::uint32_t* numbers;
    std::uint8_t* groups;
    std::uint64_t* hits;     // words of candidates, for eight agents
    std::uint64_t* members;  // the same for kMostGroups groups
    std::uint32_t* found;    // the neighbours of one agent
    std::uint32_t capacity;
    void (*grow)(RadiusTile& tile, std::size_t count);
    void* owner;
    std::uint32_t count;  // of candidates
    std::uint32_t wordCount;
    std::uint32_t own;  // the agent's place among them
};

/// Numbers of groups are below this.
inline constexpr std::uint32_t kMostGroups = 32;

/// Whom a kernel tells each agent's neighbours.
struct RadiusVisitor {
    void (*visit)(void* owner, std::uint32_t agent, const std::uint32_t* neighbours,
                  std::size_t count);
    void* owner;
};

template <class Scalar>
struct Kernels {
    /// Finds the bucket of each of `count` boxes, counted over all levels: of the first cell size that is
    /// no smaller, or that of the list.
    void (*fileBoxes)(const SizeClass<Scalar>* classes, std::size_t classCount,
                      std::uint32_t listBucket, const PaddedBox<Scalar>* boxes, std::size_t count,
                      std::uint32_t* buckets);

    /// Finds every two entries of a level with cells that overlap, the first one from firstEntry to
    /// lastEntry; over the whole level each pair once. Where `groups` is not null, this and the
    /// next one leave out those that may not pair. A join always goes to its end: its sink always
    /// makes room, or throws. The searches below return false when the sink has ended them.
    void (*joinLevel)(const Level<Scalar>& level, const GroupsView* groups,
                      std::uint32_t firstEntry, std::uint32_t lastEntry, PairSink& found,
                      KernelCost& cost);

    /// Finds (i, entry) for every box i from first to last of `queries`, which has columns like the
    /// level's, and every entry of the level that overlaps it.
    bool (*queryLevel)(const Level<Scalar>& level, const GroupsView* groups,
                       const Scalar* const* queries, std::uint32_t first, std::uint32_t last,
                       PairSink& found, KernelCost& cost);

    /// The same for all groups, but for entries that are not within reach of ways[wayOf[i]] between
    /// the times 0 and 1; some that it just misses may be found.
    bool (*querySwept)(const Level<Scalar>& level, const Scalar* const* queries,
                       const SweptBox<Scalar>* ways, const std::uint32_t* wayOf,
                       std::uint32_t first, std::uint32_t last, PairSink& found, KernelCost& cost);

    /// Finds (0, entry) for every entry in the cells of a part of a ray, or with `readsAll` every entry of
    /// the level, that the ray may meet.
    bool (*queryRay)(const Level<Scalar>& level, const RayPart<Scalar>& part, bool readsAll,
                     PairSink& found, KernelCost& cost);

    /// As queryLevel(), sooner where boxes that follow each other are near each other.
    bool (*queryBatch)(const Level<Scalar>& level, const Scalar* const* queries,
                       std::uint32_t first, std::uint32_t last, PairSink& found, KernelCost& cost);

    /// Finds the index of every entry of a level with cells that is in the volume, and perhaps of
    /// some that were erased.
    bool (*walkVolume)(const Level<Scalar>& level, const Volume<Scalar>& volume, IndexSink& found,
                       KernelCost& cost);

    /// Finds the indices of a tree's boxes that the ray may meet up to sink.last, about from near to
    /// far. The tree's blocks from firstInner on stand above others.
    bool (*walkRay)(const TreeNode8* blocks, std::uint32_t root, std::uint32_t firstInner,
                    const RayLanes& ray, RaySink& sink, KernelCost& cost);

    /// What walkRay() asks of each block: bit k tells whether the ray may meet box k at some t in
    /// [0, last]; enter[k] is then a lower bound of that t.
    std::uint32_t (*mayMeet)(const TreeNode8& block, const RayLanes& ray, float last, float* enter);

    /// As joinLevel(), of a level without cells.
    void (*joinList)(const Level<Scalar>& level, const GroupsView* groups, std::uint32_t firstEntry,
                     std::uint32_t lastEntry, PairSink& found, KernelCost& cost);

    /// The least and the greatest number of a column, from entry first to last.
    void (*findRange)(const Scalar* column, std::uint32_t first, std::uint32_t last, Scalar* least,
                      Scalar* greatest);

    /// Writes those of `count` pairs whose boxes do not overlap, the boxes order[a] and order[b],
    /// or a and b where order is null, to `apart`, which has room for all. Returns their number.
    std::size_t (*selectApart)(const IndexPair* pairs, std::size_t count,
                               const std::uint32_t* order, const PaddedBox<Scalar>* boxes,
                               IndexPair* apart);

    /// Bit k of rows[i] tells whether the boxes i and k overlap, for k < i. There are 32 at most, whose corners
    /// are the six numbers at corners + stride * indices[i], the min corner first. `boxes` is scratch.
    void (*overlapRows)(const Scalar* corners, std::size_t stride, const std::uint32_t* indices,
                        std::size_t count, PaddedBox<Scalar>* boxes, std::uint32_t* rows);

    /// Writes the numbers of those of the pairs first to last to `turned`, which has room for all, whose
    /// boxes, by column, overlap now though overlapped[i] is 0, or do not though it is 1. Returns how many.
    std::size_t (*selectTurned)(const IndexPair* pairs, const std::uint8_t* overlapped,
                                std::uint32_t first, std::uint32_t last,
                                const Scalar* const* columns, std::uint32_t* turned);

    /// Counts the neighbours of the agents first to last. This and the next two return how many
    /// neighbours there are in all.
    std::uint64_t (*countWithin)(const RadiusView<Scalar>& view, std::uint32_t first,
                                 std::uint32_t last, RadiusTile<Scalar>& tile,
                                 std::uint32_t* counts, KernelCost& cost);

    /// The same for each group: counts[agent * groupCount + group]. Groups that are not below
    /// groupCount are left out.
    std::uint64_t (*countGroupsWithin)(const RadiusView<Scalar>& view, std::uint32_t first,
                                       std::uint32_t last, RadiusTile<Scalar>& tile,
                                       const std::uint8_t* groups, std::uint32_t groupCount,
                                       std::uint32_t* counts, KernelCost& cost);

    /// Tells the visitor the neighbours of each of the agents first to last.
    std::uint64_t (*listWithin)(const RadiusView<Scalar>& view, std::uint32_t first,
                                std::uint32_t last, RadiusTile<Scalar>& tile,
                                const RadiusVisitor& visitor, KernelCost& cost);
};

}  // namespace hashphase::detail
