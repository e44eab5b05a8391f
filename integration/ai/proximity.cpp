// SPDX-License-Identifier: Zlib
#include <integration/ai/proximity.hpp>

#include <broadphase/cells_region.hpp>
#include <broadphase/position_region.hpp>

#include <algorithm>

namespace hashphase {
namespace {

template <class Scalar, class Region>
QueryCost findIn(const Grid<Scalar>& grid, const Region& region, std::vector<ProxyId>& found,
                 ProxyFilter filter, ProxyId self) {
    found.clear();
    CollectAll all(found);
    const auto isWanted = [&](ProxyId id) { return id != self && filter(id); };
    CollectIf wanted(all, isWanted);
    const QueryCost cost = grid.visit(region, wanted);
    std::sort(found.begin(), found.end());
    return cost;
}

}  // namespace

template <class Scalar>
QueryCost findWithin(const Grid<Scalar>& grid,
                     const Vector3<std::type_identity_t<Scalar>>& position,
                     std::type_identity_t<Scalar> radius, std::vector<ProxyId>& found,
                     ProxyFilter filter, ProxyId self) {
    return findIn(grid, PositionRegion<Scalar>(position, radius), found, filter, self);
}

template <class Scalar>
QueryCost estimateWithin(const Grid<Scalar>& grid,
                         const Vector3<std::type_identity_t<Scalar>>& position,
                         std::type_identity_t<Scalar> radius, std::vector<ProxyId>& found,
                         ProxyFilter filter, ProxyId self) {
    const CellsRegion<Scalar> region(position, radius, grid.cellSize());
    return findIn(grid, region, found, filter, self);
}

template QueryCost findWithin(const Grid<float>&, const Vector3<float>&, float,
                              std::vector<ProxyId>&, ProxyFilter, ProxyId);
template QueryCost findWithin(const Grid<double>&, const Vector3<double>&, double,
                              std::vector<ProxyId>&, ProxyFilter, ProxyId);
template QueryCost estimateWithin(const Grid<float>&, const Vector3<float>&, float,
                                  std::vector<ProxyId>&, ProxyFilter, ProxyId);
template QueryCost estimateWithin(const Grid<double>&, const Vector3<double>&, double,
                                  std::vector<ProxyId>&, ProxyFilter, ProxyId);

}  // namespace hashphase
