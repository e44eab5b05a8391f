// SPDX-License-Identifier: Zlib
#pragma once

// Every query of a grid against its brute-force twin, and random regions where proxies are. Compiled once for
// all test programs, for the regions of the grid in float and double.

#include <broadphase/cells_region.hpp>
#include <broadphase/convex_region.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/moving_box.hpp>
#include <broadphase/position_region.hpp>
#include <tests/support/oracles.hpp>
#include <tests/support/random.hpp>

#include <gtest/gtest.h>

#include <algorithm>
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

private:
    static std::size_t expectOnceLikeBruteForce(const Grid<Scalar>& grid,
                                                std::span<const Placed<Scalar>> proxies,
                                                const Region& region);
};

template <class Scalar, class Region>
typename CollectKeys<Scalar>::Found QueryCheck<Scalar, Region>::find(const Grid<Scalar>& grid,
                                                                     const Region& region) {
    CollectKeys<Scalar> found;
    const QueryCost cost = grid.visit(region, found);
    EXPECT_EQ(cost.hits, found.sorted().size());
    if constexpr (!requires { region.volume(); }) {  // of which cells may be taken without tests
        EXPECT_GE(cost.boxesTested, cost.hits);
    }
    return found.sorted();
}

template <class Scalar, class Region>
std::size_t QueryCheck<Scalar, Region>::expectLikeBruteForce(
    const Grid<Scalar>& grid, std::span<const Placed<Scalar>> proxies, const Region& region) {
    const std::size_t count = expectOnceLikeBruteForce(grid, proxies, region);
    // Few rays walk through cells. From now on they walk through trees, until something is filed.
    if (requires { region.segment(); } && count % 4 == 3) {
        grid.expectRays(1000);
        expectOnceLikeBruteForce(grid, proxies, region);
    }
    return count;
}

template <class Scalar, class Region>
std::size_t QueryCheck<Scalar, Region>::expectOnceLikeBruteForce(
    const Grid<Scalar>& grid, std::span<const Placed<Scalar>> proxies, const Region& region) {
    CollectKeys<Scalar> all;
    visitByBruteForce(proxies, region, all);
    const auto expected = all.sorted();
    EXPECT_EQ(differences(find(grid, region), expected), "");

    CollectClosest<Scalar> closest;
    CollectClosest<Scalar> expectedClosest;
    grid.visit(region, closest);
    visitByBruteForce(proxies, region, expectedClosest);
    EXPECT_EQ(closest.found(), expectedClosest.found());
    EXPECT_EQ(closest.key(), expectedClosest.key());

    CollectAny any;
    grid.visit(region, any);
    EXPECT_EQ(any.found().isNull(), expected.empty());
    EXPECT_TRUE(expected.empty() ||
                std::any_of(expected.begin(), expected.end(),
                            [&any](const auto& found) { return found.first == any.found(); }));

    CollectCount count;
    grid.visit(region, count);
    EXPECT_EQ(count.count(), expected.size());
    return expected.size();
}

extern template struct QueryCheck<float, BoxRegion<float>>;
extern template struct QueryCheck<float, SphereRegion<float>>;
extern template struct QueryCheck<float, RayRegion<float>>;
extern template struct QueryCheck<float, ConvexRegion<float>>;
extern template struct QueryCheck<float, PositionRegion<float>>;
extern template struct QueryCheck<float, CellsRegion<float>>;
extern template struct QueryCheck<float, MovingBoxRegion<float>>;
extern template struct QueryCheck<double, BoxRegion<double>>;
extern template struct QueryCheck<double, SphereRegion<double>>;
extern template struct QueryCheck<double, RayRegion<double>>;
extern template struct QueryCheck<double, ConvexRegion<double>>;
extern template struct QueryCheck<double, PositionRegion<double>>;
extern template struct QueryCheck<double, CellsRegion<double>>;
extern template struct QueryCheck<double, MovingBoxRegion<double>>;

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
