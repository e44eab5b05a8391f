// SPDX-License-Identifier: Zlib
#pragma once

// Every query of a grid against its brute-force twin, and random regions where proxies are.

#include <broadphase/convex_region.hpp>
#include <broadphase/grid.hpp>
#include <tests/support/oracles.hpp>
#include <tests/support/random.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

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

/// What the grid finds, with keys, sorted.
template <class Scalar, class Region>
[[nodiscard]] typename CollectKeys<Scalar>::Found find(const Grid<Scalar>& grid,
                                                       const Region& region) {
    CollectKeys<Scalar> found;
    const QueryCost cost = grid.visit(region, found);
    EXPECT_EQ(cost.hits, found.sorted().size());
    if constexpr (!requires { region.volume(); }) {  // of which cells may be taken without tests
        EXPECT_GE(cost.boxesTested, cost.hits);
    }
    return found.sorted();
}

/// All collectors find what they find by brute force, with the same keys, each proxy once. Returns
/// how many there are.
template <class Scalar, class Region>
std::size_t expectLikeBruteForce(const Grid<Scalar>& grid, std::span<const Placed<Scalar>> proxies,
                                 const Region& region) {
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

/// visitCell() finds what has the cell among its own, each proxy once.
template <class Scalar>
void expectCellLikeBruteForce(const Grid<Scalar>& grid, std::span<const Placed<Scalar>> proxies,
                              const std::array<std::int64_t, 3>& cell) {
    typename CollectKeys<Scalar>::Found expected;
    for (const Placed<Scalar>& proxy : proxies) {
        bool isIn = proxy.box.min().allFinite() && proxy.box.max().allFinite();
        const CellRange cells = isIn ? grid.cellsOf(proxy.id) : CellRange{};
        EXPECT_TRUE(!isIn || cells.lowest == grid.cellAt(proxy.box.min()));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            isIn = isIn && cells.lowest[axis] <= cell[axis] && cell[axis] <= cells.highest[axis];
        }
        if (isIn) {
            expected.emplace_back(proxy.id, Scalar(0));
        }
    }
    std::sort(expected.begin(), expected.end());
    CollectKeys<Scalar> found;
    grid.visitCell(cell, found);
    EXPECT_EQ(differences(found.sorted(), expected), "");
}

/// Draws regions that begin and end at corners of proxies or near them.
template <class Scalar>
class RegionMaker {
public:
    RegionMaker(Random& random, std::span<const Placed<Scalar>> proxies)
        : random_(random), proxies_(proxies) {}

    Vector3<Scalar> point() {
        const Aabb<Scalar>& box = anyBox();
        Vector3<Scalar> point;
        for (int axis = 0; axis < 3; ++axis) {
            point[axis] = (random_.chance(0.5) ? box.min() : box.max())[axis];
        }
        return random_.chance(0.3)
                   ? point
                   : Vector3<Scalar>(point +
                                     sizes().cwiseProduct(random_.pointIn(-2, 2).cast<Scalar>()));
    }

    BoxRegion<Scalar> box() {
        const Vector3<Scalar> a = point();
        const Vector3<Scalar> b = random_.chance(0.2)   ? a
                                  : random_.chance(0.5) ? Vector3<Scalar>(a + sizes())
                                                        : point();
        if (random_.chance(0.05)) {
            return {Aabb<Scalar>(a, b)};  // perhaps inverted
        }
        return {Aabb<Scalar>(a.cwiseMin(b), a.cwiseMax(b))};
    }

    SphereRegion<Scalar> sphere() {
        const auto size = static_cast<double>(sizes().maxCoeff());
        const double radius = random_.chance(0.1) ? 0 : size * random_.logBetween(0.1, 30);
        return {point(), static_cast<Scalar>(radius)};
    }

    /// Some along an axis, some in a plane, some without length.
    RayRegion<Scalar> ray(bool fat = false) {
        const Vector3<Scalar> from = point();
        Vector3<Scalar> to = random_.chance(0.1) ? from : point();
        for (int axis = 0; axis < 3; ++axis) {
            if (random_.chance(0.25)) {
                to[axis] = from[axis];
            }
        }
        if (!fat) {
            return {from, to};
        }
        const Vector3<Scalar> half = sizes() * static_cast<Scalar>(random_.logBetween(0.1, 4));
        return {from, to, {Vector3<Scalar>(half * Scalar(-0.75)), half}};
    }

    /// Boxes, prisms, wedges, half-spaces and contradictions.
    ConvexRegion<Scalar> convex() {
        using Plane = typename ConvexRegion<Scalar>::Plane;
        std::vector<Plane> planes;
        const Vector3<Scalar> inside = point();
        const std::uint32_t count = random_.below(8);
        for (std::uint32_t i = 0; i < count; ++i) {
            Vector3<Scalar> normal = random_.pointIn(-1, 1).cast<Scalar>();
            for (int axis = 0; axis < 3; ++axis) {
                normal[axis] = random_.chance(0.2) ? Scalar(0) : normal[axis];
            }
            const Vector3<Scalar> in = point();
            const bool isTowards = random_.chance(0.9);
            const Plane plane(normal, in);
            planes.push_back(plane.signedDistance(inside) < 0 && isTowards
                                 ? Plane(-normal, -plane.offset())
                                 : plane);
        }
        return ConvexRegion<Scalar>(
            planes, random_.chance(0.3) ? Containment::inside : Containment::touching,
            random_.chance(0.5) ? Touch::exact : Touch::byPlanes);
    }

private:
    const Aabb<Scalar>& anyBox() {
        return proxies_[random_.below(static_cast<std::uint32_t>(proxies_.size()))].box;
    }
    Vector3<Scalar> sizes() {
        const Aabb<Scalar>& box = anyBox();
        return (box.max() - box.min()).cwiseAbs();
    }

    Random& random_;
    std::span<const Placed<Scalar>> proxies_;
};

/// So many random regions of each kind, where proxies are. Returns how often they find one.
template <class Scalar>
std::size_t expectQueriesLikeBruteForce(const Grid<Scalar>& grid,
                                        std::span<const Placed<Scalar>> proxies, Random& random,
                                        int count) {
    RegionMaker<Scalar> make(random, proxies);
    std::size_t found = 0;
    for (int i = 0; i < count && !testing::Test::HasFailure(); ++i) {
        found += expectLikeBruteForce(grid, proxies, make.box());
        found += expectLikeBruteForce(grid, proxies, make.sphere());
        found += expectLikeBruteForce(grid, proxies, make.ray());
        found += expectLikeBruteForce(grid, proxies, make.ray(true));
        found += expectLikeBruteForce(grid, proxies, make.convex());
    }
    return found;
}

}  // namespace hashphase::test
