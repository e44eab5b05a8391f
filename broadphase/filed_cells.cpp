// SPDX-License-Identifier: Zlib
#include <broadphase/filed_cells.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <tuple>

namespace hashphase {
namespace {

using detail::Cell;

/// Where a proxy is filed: two levels have no cell in common.
template <class Scalar>
struct Place {
    std::ptrdiff_t tableNumber;
    std::size_t levelNumber;
    Cell cell;
    const detail::Level<Scalar>* level;

    [[nodiscard]] auto key() const noexcept { return std::tie(tableNumber, levelNumber, cell); }
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

/// The number of the level that has the entry.
template <class Scalar>
std::size_t levelOf(const detail::Table<Scalar>& table, std::uint32_t entry) {
    const auto levels = table.levels();
    const auto isBefore = [entry](const auto& level) { return level.lastEntry <= entry; };
    return static_cast<std::size_t>(std::partition_point(levels.begin(), levels.end(), isBefore) -
                                    levels.begin());
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
    store.mendTables();
    // No query: it would count as one, and file what has changed.
    const detail::Reading<Scalar> reading = store.tables.reading();
    FiledCells<Scalar> found;
    std::vector<Place<Scalar>> places;
    store.forEachPlace(
        reading,
        [&](const detail::Filing<Scalar>& filing, std::uint32_t entry, std::uint32_t proxyIndex) {
            const detail::Table<Scalar>& table = *filing.table;
            const std::size_t levelNumber = levelOf(table, entry);
            const detail::Level<Scalar>& level = table.levels()[levelNumber];
            if (!level.hasCells()) {
                found.unfiled.push_back(store.proxies.idOf(proxyIndex));
                return;
            }
            const Vector3<Scalar> corner =
                (filing.isResting ? store.filedBox(entry) : table.box(entry)).min();
            places.push_back(
                {&filing - reading.filings().data(),
                 levelNumber,
                 {level.cell(corner.x(), 0), level.cell(corner.y(), 1), level.cell(corner.z(), 2)},
                 &level});
        },
        [&](std::uint32_t proxyIndex) { found.unfiled.push_back(store.proxies.idOf(proxyIndex)); });
    std::sort(found.unfiled.begin(), found.unfiled.end());
    found.cells = cellsAt(places);
    return found;
}

template FiledCells<float> filedCells(const Grid<float>&);
template FiledCells<double> filedCells(const Grid<double>&);

}  // namespace hashphase
