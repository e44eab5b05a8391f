// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/store/store.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace hashphase::detail {

/// A table in old coordinates, and what is filed in it.
template <class Scalar>
struct OwnTable : Table<Scalar> {
    std::vector<PaddedBox<Scalar>> boxes;     // scratch
    std::vector<std::uint32_t> proxyIndices;  // scratch
};

/// A table of boxes as of the last update: of what was mobile then, and of the first indexedWoken of what has
/// left rest since. Either the grid's own, until it is filed again, or one of this object's.
template <class Scalar>
struct LastUpdate {
    enum class Place : std::uint8_t { nowhere, mobileTable, ownTable };

    Store<Scalar>& store;
    Place place = Place::nowhere;
    std::unique_ptr<OwnTable<Scalar>> ownTable{};  // made when it is first needed
    std::size_t indexedWoken = 0;
    std::uint64_t filing = 0;  // Tables::filingCount and ...
    std::uint64_t shift = 0;   // ... Store::shiftCount at that time

    /// Those that have them.
    [[nodiscard]] const Table<Scalar>& table() const noexcept {
        const Table<Scalar>& mobile = store.tables.mobile;
        return place == Place::ownTable ? *ownTable : mobile;
    }

    void forget() noexcept { place = Place::nowhere; }
    /// The table there has just been filed with the boxes.
    void take(Place filed) noexcept {
        place = filed;
        indexedWoken = 0;
        filing = store.tables.filingCount;
        shift = store.shiftCount;
    }
    /// The own table, for what the caller files in it.
    [[nodiscard]] OwnTable<Scalar>& scratchTable() {
        if (ownTable == nullptr) {
            ownTable = std::make_unique<OwnTable<Scalar>>();
        }
        return *ownTable;
    }
    /// Files the boxes of these proxies as of the last update in the own table, and no others; after
    /// forget(), since they may be in that one.
    const Table<Scalar>& file(const std::vector<std::uint32_t>& ofProxies, ParallelFor parallelFor,
                              const ProxyGroups* groups) {
        OwnTable<Scalar>& own = scratchTable();
        own.boxes.clear();
        for (const std::uint32_t proxyIndex : ofProxies) {
            own.boxes.push_back(padded(store.boxAtUpdate(proxyIndex)));
        }
        own.build(ofProxies, own.boxes, store.fixedSizes(), parallelFor, groups);
        return own;
    }
    /// Afterwards table() has all but `mostUnindexed` of the proxies that are mobile now, and that were
    /// there at the last update. Each time that it is filed for more of them it has a quarter more, so
    /// that this costs each of them little.
    void index(std::size_t mostUnindexed);

    /// What is copied: core/copy_parts.hpp.
    template <class Visit>
    static void forEachPart(LastUpdate& to, const LastUpdate& from, const Visit& visit) {
        visit(to.place, from.place);
        visit(to.ownTable, from.ownTable);
        visit(to.indexedWoken, from.indexedWoken);
        visit(to.filing, from.filing);
        visit(to.shift, from.shift);
    }

    void releaseMemory() noexcept {
        place = place == Place::ownTable ? Place::nowhere : place;
        ownTable.reset();
    }
    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return ownTable == nullptr ? 0
                                   : sizeof(*ownTable) + ownTable->memoryBytes() +
                                         ownTable->boxes.capacity() * sizeof(PaddedBox<Scalar>) +
                                         ownTable->proxyIndices.capacity() * sizeof(std::uint32_t);
    }
};

template <class Scalar>
void LastUpdate<Scalar>::index(std::size_t mostUnindexed) {
    const bool isStale = shift != store.shiftCount ||
                         (place == Place::mobileTable && filing != store.tables.filingCount);
    if (isStale) {
        forget();
    }
    const Population<Scalar>& proxies = store.proxies;
    if (place != Place::nowhere && proxies.woken.size() - indexedWoken <= mostUnindexed) {
        return;
    }
    // What has come since the last update had no box then.
    const auto listed = proxies.mobile.begin();
    std::vector<std::uint32_t>& proxyIndices = scratchTable().proxyIndices;
    proxyIndices.assign(listed, listed + static_cast<std::ptrdiff_t>(proxies.mobileAtUpdate));
    proxyIndices.insert(proxyIndices.end(), proxies.woken.begin(), proxies.woken.end());
    forget();
    file(proxyIndices, serialFor, proxies.groupsOfAllAtUpdate());
    take(Place::ownTable);
    indexedWoken = proxies.woken.size();
}

}  // namespace hashphase::detail
