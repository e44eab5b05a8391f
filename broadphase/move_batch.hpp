// SPDX-License-Identifier: Zlib
#pragma once

// Moves many proxies on several threads. The result equals single moves in order.
//
// No two threads write the same record at once. Each part of the batch counts and lists its changes. Afterwards,
// join() adds the changes of all parts to the store, in order. Settled proxies that stay within their enlarged box
// move on any thread. So do mobile proxies that do not sweep and have no NaN, before or after the move. For all other
// proxies, join() calls Store::move() in the order of the batch.

#include <broadphase/parallel_for.hpp>
#include <broadphase/store/store.hpp>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <vector>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::detail {

/// A proxy and its new box.
template <class Scalar>
struct Move {
    std::uint32_t proxyIndex;
    Aabb<Scalar> box;
};

/// True when no proxy appears twice: the results of indexOf(i) for all i < count differ, except kNoProxyIndex.
/// Results other than kNoProxyIndex must be below `indexLimit`. False if count > indexLimit. May call indexOf() from
/// several threads at once. Cost: two passes over the moves.
template <class IndexOf>
[[nodiscard]] bool areDistinct(MoveScratch& scratch, std::size_t count, std::size_t indexLimit,
                               ParallelFor parallelFor, const IndexOf& indexOf) {
    if (count > indexLimit) {
        return false;
    }
    if (scratch.namedBy.size() < indexLimit) {
        scratch.namedBy = std::vector<std::atomic<std::uint32_t>>(indexLimit + indexLimit / 2);
    }
    // If several i have the same index, only the last writer finds its own i in the second loop.
    parallelFor(count, MoveScratch::kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (const std::uint32_t index = indexOf(i); index != kNoProxyIndex) {
                scratch.namedBy[index].store(static_cast<std::uint32_t>(i),
                                             std::memory_order_relaxed);
            }
        }
    });
    std::atomic<bool> isAnyTwice{false};
    parallelFor(count, MoveScratch::kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t index = indexOf(i);
            if (index != kNoProxyIndex &&
                scratch.namedBy[index].load(std::memory_order_relaxed) != i) {
                isAnyTwice.store(true, std::memory_order_relaxed);
            }
        }
    });
    return !isAnyTwice.load(std::memory_order_relaxed);
}

template <class Scalar>
class MoveBatch {
public:
    explicit MoveBatch(Store<Scalar>& store) : store_(store), scratch_(store.scratchOfMoves()) {}

    /// Calls prepare(i) once for each i < count. If prepare(i) returns true, calls moveOf(i) once or twice, and
    /// applies that move once. Both functions may run on any thread. No proxy may appear twice. If `parallelFor`
    /// throws, some of the moves may be missing.
    template <class Prepare, class MoveOf>
    void run(std::size_t count, ParallelFor parallelFor, const Prepare& prepare,
             const MoveOf& moveOf) {
        constexpr std::size_t kGrain = MoveScratch::kGrain;
        std::size_t first = 0;
        // Moves proxies one by one while Tables::fresh is in use. The first move that changes a box makes it
        // the mobile table, and ends this loop.
        for (; first < count && store_.tables.isFresh.load(std::memory_order_relaxed); ++first) {
            if (prepare(first)) {
                moveInTurn(moveOf(first));
            }
        }
        const std::size_t left = count - first;
        scratch_.parts.assign((left + kGrain - 1) / kGrain, {});
        scratch_.entries.resize(std::max(scratch_.entries.size(), left));
        const auto movePart = [&](std::size_t number) {
            Part& part = scratch_.parts[number];
            const std::size_t begin = first + number * kGrain;
            const std::size_t end = std::min(begin + kGrain, count);
            for (std::size_t i = begin; i < end; ++i) {
                if (prepare(i)) {
                    moveNow(moveOf(i), static_cast<std::uint32_t>(i - begin), part,
                            scratch_.entries.data() + number * kGrain);
                }
            }
        };
        const auto joinAll = [&] {
            for (std::size_t number = 0; number < scratch_.parts.size(); ++number) {
                const std::size_t begin = first + number * kGrain;
                join(number, [&](std::uint32_t offset) { return moveOf(begin + offset); });
            }
        };
        // Joins the parts, also when `parallelFor` throws.
        const AtEnd<decltype(joinAll)> atEnd(joinAll);
        parallelFor(scratch_.parts.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t number = begin; number < end; ++number) {
                movePart(number);
            }
        });
    }

private:
    using Part = MoveScratch::Part;

    template <class Call>
    struct AtEnd {
        const Call& call;
        explicit AtEnd(const Call& toCall) : call(toCall) {}
        ~AtEnd() { call(); }
        AtEnd(const AtEnd&) = delete;
        AtEnd& operator=(const AtEnd&) = delete;
    };

    // Marks entries that join() moves.
    static constexpr std::uint32_t kInTurn = std::uint32_t{1} << 31;

    void moveInTurn(const Move<Scalar>& move) { store_.move(move.proxyIndex, move.box); }

    void moveNow(const Move<Scalar>& move, std::uint32_t offset, Part& part,
                 std::uint32_t* entries) {
        Record<Scalar>& record = store_.proxies.records[move.proxyIndex];
        if (isSameBits(record.box, move.box)) {
            return;
        }
        if (!store_.movesInPlace(record, move.box)) {
            part.areAllListed = false;
            entries[part.entryCount++] = kInTurn | offset;
            return;
        }
        store_.moveInPlace(record, move.box, part.changed, part.settledChanged,
                           [&]() noexcept { entries[part.entryCount++] = move.proxyIndex; });
    }

    // Adds the changes of one part to the store. Call it in the order of the parts.
    template <class MoveAt>
    void join(std::size_t number, const MoveAt& moveAt) {
        RoomyList<std::uint32_t>& waiting = store_.proxies.waiting;
        const Part& part = scratch_.parts[number];
        const std::uint32_t* const entries = scratch_.entries.data() + number * MoveScratch::kGrain;
        store_.cost.changed += part.changed;
        store_.proxies.settledChanged += part.settledChanged;
        if (part.areAllListed) {
            std::copy(entries, entries + part.entryCount, std::back_inserter(waiting));
            return;
        }
        for (std::uint32_t i = 0; i < part.entryCount; ++i) {
            if ((entries[i] & kInTurn) != 0) {
                moveInTurn(moveAt(entries[i] & ~kInTurn));
            } else {
                waiting.push_back(entries[i]);
            }
        }
    }

    Store<Scalar>& store_;
    MoveScratch& scratch_;
};

}  // namespace hashphase::detail

#include <broadphase/core/restore_macros.hpp>
