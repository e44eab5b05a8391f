// SPDX-License-Identifier: Zlib
#include <broadphase/filed_cells.hpp>

#include <algorithm>
#include <cstdint>
#include <tuple>

namespace hashphase {
namespace {

using detail::Cell;

/// Where a proxy is filed: two levels have no cell in common.
template <class Scalar>
struct Place {
    std::uint32_t levelNumber;  // among all tables' levels
    Cell cell;
    const detail::Level<Scalar>* level;

    [[nodiscard]] auto key() const noexcept { return std::tie(levelNumber, cell); }
};

template <class Scalar>
Aabb<Scalar> boxOf(const Place<Scalar>& place) {
    const detail::Level<Scalar>& level = *place.level;
    Aabb<Scalar> box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto at = static_cast<Eigen::Index>(axis);
        if (level.inverseCellSize[axis] == 0) {
            box.min()[at] = level.lowest[axis];
            box.max()[at] = level.highest[axis];
            continue;
        }
        const auto border = [&](double cell) {
            return static_cast<Scalar>(static_cast<double>(level.origin[axis]) +
                                       cell / static_cast<double>(level.inverseCellSize[axis]));
        };
        box.min()[at] = border(place.cell[axis]);
        box.max()[at] = border(place.cell[axis] + 1.0);
    }
    return box;
}

/// Lists the places of what a table files, and what it lists without cells.
template <class Scalar>
void readTable(const detail::Store<Scalar>& store, const detail::Reading<Scalar>& reading,
               const detail::Filing<Scalar>& filing, std::uint32_t levelNumber,
               std::vector<Place<Scalar>>& places, std::vector<ProxyId>& unfiled) {
    const detail::Table<Scalar>& table = *filing.table;
    for (const detail::Level<Scalar>& level : table.levels()) {
        ++levelNumber;
        for (std::uint32_t entry = level.firstEntry; entry < level.lastEntry; ++entry) {
            const std::uint32_t proxyIndex = table.proxyIndex(entry);
            if (!store.standsIn(filing, proxyIndex, reading) || hasNan(table.box(entry))) {
                continue;
            }
            if (!level.hasCells()) {
                unfiled.push_back(store.proxies.idOf(proxyIndex));
                continue;
            }
            const Vector3<Scalar> corner =
                (filing.isResting ? store.filedBox(entry) : table.box(entry)).min();
            places.push_back(
                {levelNumber,
                 {level.cell(corner.x(), 0), level.cell(corner.y(), 1), level.cell(corner.z(), 2)},
                 &level});
        }
    }
}

/// One for each place that differs, the fullest first.
template <class Scalar>
std::vector<FiledCell<Scalar>> cellsAt(std::vector<Place<Scalar>>& places) {
    std::sort(places.begin(), places.end(),
              [](const auto& a, const auto& b) { return a.key() < b.key(); });
    std::vector<FiledCell<Scalar>> cells;
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (i == 0 || places[i].key() != places[i - 1].key()) {
            cells.push_back({boxOf(places[i]), 0});
        }
        ++cells.back().load;
    }
    std::stable_sort(cells.begin(), cells.end(),
                     [](const auto& a, const auto& b) { return a.load > b.load; });
    return cells;
}

}  // namespace

template <class Scalar>
FiledCells<Scalar> filedCells(const Grid<Scalar>& grid) {
    const detail::Store<Scalar>& store = grid.store();
    const detail::Reading<Scalar> reading = store.beginReading();
    FiledCells<Scalar> found;
    std::vector<Place<Scalar>> places;
    std::uint32_t levelNumber = 0;
    for (const detail::Filing<Scalar>& filing : reading.filings()) {
        readTable(store, reading, filing, levelNumber, places, found.unfiled);
        levelNumber += static_cast<std::uint32_t>(filing.table->levels().size());
    }
    for (std::size_t i = 0; i < store.proxies.waiting.size() && !reading.isFresh; ++i) {
        const std::uint32_t proxyIndex = store.proxies.waiting[i];
        if (store.proxies.isAlive(proxyIndex) && !store.proxies.records[proxyIndex].isNan) {
            found.unfiled.push_back(store.proxies.idOf(proxyIndex));
        }
    }
    std::sort(found.unfiled.begin(), found.unfiled.end());
    found.cells = cellsAt(places);
    return found;
}

template FiledCells<float> filedCells(const Grid<float>&);
template FiledCells<double> filedCells(const Grid<double>&);

}  // namespace hashphase
