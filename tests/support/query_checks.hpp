// SPDX-License-Identifier: Zlib
#pragma once

// Every query of a grid against its brute-force twin, and random regions where proxies are. Compiled once for
// all test programs, for the regions of the library in float and double.

#include <broadphase/cells_region.hpp>
#include <broadphase/convex_region.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/moving_box.hpp>
#include <broadphase/position_region.hpp>
#include <tests/support/oracles.hpp>
#include <tests/support/random.hpp>

#include <array>
#include <cstdint>
#include <span>

namespace hashphase::test {

/// A grid as a World for scripts.
template <class Scalar>
struct GridWorld {
    Grid<Scalar> grid;

    explicit GridWorld(const GridConfig& config = {}) : grid(config) {}

    ProxyId add(const Aabb<Scalar>& box, Mobility mobility) { return grid.add(box, mobility); }
    void move(ProxyId id, const Aabb<Scalar>& box) { grid.move(id, box); }
    void remove(ProxyId id) { grid.remove(id); }
    void update() { grid.update(); }
    void shiftOrigin(const Vector3<Scalar>& shift) { grid.shiftOrigin(shift); }
    void clear() { grid.clear(); }
    static void refilter(ProxyId /*id*/) {}
};

template <class Scalar, class Region>
struct QueryCheck {
    static typename CollectKeys<Scalar>::Found find(const Grid<Scalar>& grid, const Region& region);
    static std::size_t expectLikeBruteForce(const Grid<Scalar>& grid,
                                            std::span<const Placed<Scalar>> proxies,
                                            const Region& region);
};

/// What the grid finds, with keys, sorted.
template <class Scalar, class Region>
[[nodiscard]] auto find(const Grid<Scalar>& grid, const Region& region) {
    return QueryCheck<Scalar, Region>::find(grid, region);
}

/// All collectors find what they find by brute force, with the same keys, each proxy once. Returns
/// how many there are.
template <class Scalar, class Region>
std::size_t expectLikeBruteForce(const Grid<Scalar>& grid, std::span<const Placed<Scalar>> proxies,
                                 const Region& region) {
    return QueryCheck<Scalar, Region>::expectLikeBruteForce(grid, proxies, region);
}

/// visitCell() finds what has the cell among its own, each proxy once.
template <class Scalar>
void expectCellLikeBruteForce(const Grid<Scalar>& grid, std::span<const Placed<Scalar>> proxies,
                              const std::array<std::int64_t, 3>& cell);

/// Draws regions that begin and end at corners of proxies or near them.
template <class Scalar>
class RegionMaker {
public:
    RegionMaker(Random& random, std::span<const Placed<Scalar>> proxies)
        : random_(random), proxies_(proxies) {}

    Vector3<Scalar> point();
    BoxRegion<Scalar> box();
    SphereRegion<Scalar> sphere();

    /// Some along an axis, some in a plane, some without length.
    RayRegion<Scalar> ray(bool fat = false);

    /// Boxes, prisms, wedges, half-spaces and contradictions.
    ConvexRegion<Scalar> convex();

    /// With radii of 0 and hostile ones among them.
    PositionRegion<Scalar> positions();

private:
    const Aabb<Scalar>& anyBox();
    Vector3<Scalar> sizes();

    Random& random_;
    std::span<const Placed<Scalar>> proxies_;
};

/// So many random regions of each kind, where proxies are; boxes in motion excepted. Returns how often they
/// find one.
template <class Scalar>
std::size_t expectQueriesLikeBruteForce(const Grid<Scalar>& grid,
                                        std::span<const Placed<Scalar>> proxies, Random& random,
                                        int count);

}  // namespace hashphase::test
