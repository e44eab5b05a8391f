// SPDX-License-Identifier: Zlib
#pragma once

// Where proxies are filed: the tables that searches read, each with its tree for many rays.

#include <broadphase/core/group_kinds.hpp>
#include <broadphase/hash/table.hpp>
#include <broadphase/tree/box_tree.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>

namespace hashphase::detail {

/// A table and its tree, which is made when so many rays have come since the table was built that it pays.
template <class Scalar>
struct FiledTable : Table<Scalar> {
    BoxTree tree;
    std::atomic<bool> isTreeStale{false};
    std::atomic<std::uint64_t> walked{0};  // what rays have cost meanwhile, in boxes tested

    /// Table::build().
    void file(std::span<const std::uint32_t> proxyIndices, std::span<const PaddedBox<Scalar>> boxes,
              const LevelSizes& sizes, ParallelFor parallelFor,
              const ProxyGroups* groups = nullptr) {
        this->build(proxyIndices, boxes, sizes, parallelFor, groups);
        makeTreeStale();
    }
    [[nodiscard]] std::string validateTree() const {
        return isTreeStale.load(std::memory_order_relaxed) ? std::string() : tree.validate();
    }
    void makeTreeStale() noexcept {
        walked.store(0, std::memory_order_relaxed);
        isTreeStale.store(true, std::memory_order_relaxed);
    }
    /// What a ray has cost; it counts as if it had tested each box once at most.
    void countWalk(std::uint64_t boxesTested) noexcept {
        walked.fetch_add(std::min<std::uint64_t>(boxesTested, this->size()),
                         std::memory_order_relaxed);
    }
    /// Whether the tree is to be made before so many rays begin: when those before them, and all but the last
    /// of them, may have cost as much as the tree. One by one, rays and tree cost at most twice the least
    /// there is. Of many that begin together none makes it.
    [[nodiscard]] bool lacksTree(std::size_t rayCount) const noexcept {
        constexpr std::uint64_t kTree = 48;  // boxes tested, for each that is filed
        return isTreeStale.load(std::memory_order_acquire) &&
               walked.load(std::memory_order_relaxed) + (rayCount - 1) * this->size() >=
                   kTree * (this->size() + std::uint64_t{64});
    }
    /// What is copied: core/copy_parts.hpp.
    template <class Visit>
    static void forEachPart(FiledTable& to, const FiledTable& from, const Visit& visit) {
        visit(static_cast<Table<Scalar>&>(to), static_cast<const Table<Scalar>&>(from));
        if (!from.isTreeStale.load(std::memory_order_relaxed)) {
            visit(to.tree, from.tree);
        }
        visit(to.isTreeStale, from.isTreeStale);
        visit(to.walked, from.walked);
    }
    void swap(FiledTable& other) noexcept {
        std::swap(static_cast<Table<Scalar>&>(*this), static_cast<Table<Scalar>&>(other));
        std::swap(tree, other.tree);
        const bool isStale = isTreeStale.load(std::memory_order_relaxed);
        isTreeStale.store(other.isTreeStale.load(std::memory_order_relaxed),
                          std::memory_order_relaxed);
        other.isTreeStale.store(isStale, std::memory_order_relaxed);
        other.walked.store(walked.exchange(other.walked.load(std::memory_order_relaxed),
                                           std::memory_order_relaxed),
                           std::memory_order_relaxed);
    }
};

/// A table that queries read.
template <class Scalar>
struct Filing {
    const FiledTable<Scalar>* table;
    bool isResting;
};

/// All that a query reads: the tables of what stands, then that of what sweeps, if there is one.
template <class Scalar>
struct Reading {
    std::array<Filing<Scalar>, 3> all;
    // Filed since the last change, so that nothing waits, what sweeps with the rest.
    bool isFresh;

    // Not of a Reading that ends with the expression.
    std::span<const Filing<Scalar>> filings() const&& = delete;
    std::span<const Filing<Scalar>> standing() const&& = delete;
    [[nodiscard]] std::span<const Filing<Scalar>> filings() const& noexcept {
        return std::span(all).first(isFresh || all[2].table == nullptr ? 2 : 3);
    }
    [[nodiscard]] std::span<const Filing<Scalar>> standing() const& noexcept {
        return std::span(all).first(2);
    }
};

template <class Scalar>
struct Tables {
    FiledTable<Scalar> mobile;
    FiledTable<Scalar> resting;
    std::unique_ptr<FiledTable<Scalar>> sweeping;  // made when the first proxy sweeps
    // What a query has filed while others went on with `mobile` and the list of changes. The next change
    // makes it `mobile`, or drops it where it is made within a query, which may be reading either.
    std::unique_ptr<FiledTable<Scalar>> fresh;
    std::atomic<bool> isFresh{false};
    // `mobile` cannot be read: a shift of the origin, or want of memory, has left it as it is.
    std::atomic<bool> mustRefileMobile{false};
    std::mutex mutex;  // of queries that file, or grow trees

    std::uint32_t restingErased = 0;  // entries
    std::uint32_t settledAt = 0;      // Population::updateNumber when `resting` was filed
    std::uint32_t idleUpdates = 0;    // of mobile proxies that might rest, since then
    Scalar cellSize = 1;              // see Grid::cellSize()
    GroupKinds::Set restingKinds = 0;
    std::atomic<std::uint64_t> filingCount{0};  // a query may file while others ask
    std::atomic<std::uint64_t> waitingRead{0};  // how much of the list of changes queries have read

    /// Calls visit(table) for all of `tables` that are there, in use or not.
    template <class Self, class Visit>
    static void forAll(Self& tables, const Visit& visit) {
        visit(tables.mobile);
        visit(tables.resting);
        for (auto* late : {tables.sweeping.get(), tables.fresh.get()}) {
            if (late != nullptr) {
                visit(*late);
            }
        }
    }

    /// What is copied: core/copy_parts.hpp.
    void makeRoomFor(const Tables& from) {
        if (from.fresh != nullptr && fresh == nullptr) {
            fresh = std::make_unique<FiledTable<Scalar>>();
        }
    }
    template <class Visit>
    static void forEachPart(Tables& to, const Tables& from, const Visit& visit) {
        visit(to.mobile, from.mobile);
        visit(to.resting, from.resting);
        visit(to.sweeping, from.sweeping);
        if (from.fresh == nullptr || from.isFresh.load(std::memory_order_relaxed)) {
            visit(to.fresh, from.fresh);
        } else {
            Table<Scalar>::forEachPartToBuildOn(*to.fresh, *from.fresh, visit);
        }
        visit(to.isFresh, from.isFresh);
        visit(to.mustRefileMobile, from.mustRefileMobile);
        visit(to.restingErased, from.restingErased);
        visit(to.settledAt, from.settledAt);
        visit(to.idleUpdates, from.idleUpdates);
        visit(to.cellSize, from.cellSize);
        visit(to.restingKinds, from.restingKinds);
        visit(to.filingCount, from.filingCount);
        visit(to.waitingRead, from.waitingRead);
    }

    /// Leaves nothing filed.
    void clear() noexcept {
        for (FiledTable<Scalar>* table : {&mobile, &resting}) {
            static_cast<Table<Scalar>&>(*table) = {};
            table->tree = {};
            table->makeTreeStale();
        }
        sweeping.reset();
        fresh.reset();
        restingErased = settledAt = 0;
        idleUpdates = 0;
        waitingRead.store(0, std::memory_order_relaxed);
        mustRefileMobile.store(false, std::memory_order_relaxed);
        isFresh.store(false, std::memory_order_relaxed);
    }

    [[nodiscard]] Reading<Scalar> reading() const noexcept {
        const bool readsFresh = isFresh.load(std::memory_order_acquire);
        return {{{{readsFresh ? fresh.get() : &mobile, false},
                  {&resting, true},
                  {sweeping.get(), false}}},
                readsFresh};
    }
};

}  // namespace hashphase::detail
