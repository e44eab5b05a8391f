// SPDX-License-Identifier: Zlib
#include <tests/support/query_checks.hpp>

#include <tests/support/box_scenes.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace hashphase::test {

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

template <class Scalar>
const Aabb<Scalar>& RegionMaker<Scalar>::anyBox() {
    return proxies_[random_.below(static_cast<std::uint32_t>(proxies_.size()))].box;
}
template <class Scalar>
Vector3<Scalar> RegionMaker<Scalar>::sizes() {
    const Aabb<Scalar>& box = anyBox();
    return (box.max() - box.min()).cwiseAbs();
}

template <class Scalar>
Vector3<Scalar> RegionMaker<Scalar>::point() {
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

template <class Scalar>
BoxRegion<Scalar> RegionMaker<Scalar>::box() {
    const Vector3<Scalar> a = point();
    const Vector3<Scalar> b = random_.chance(0.2)   ? a
                              : random_.chance(0.5) ? Vector3<Scalar>(a + sizes())
                                                    : point();
    if (random_.chance(0.05)) {
        return {Aabb<Scalar>(a, b)};  // perhaps inverted
    }
    return {Aabb<Scalar>(a.cwiseMin(b), a.cwiseMax(b))};
}

template <class Scalar>
SphereRegion<Scalar> RegionMaker<Scalar>::sphere() {
    const auto size = static_cast<double>(sizes().maxCoeff());
    const double radius = random_.chance(0.1) ? 0 : size * random_.logBetween(0.1, 30);
    return {point(), static_cast<Scalar>(radius)};
}

template <class Scalar>
RayRegion<Scalar> RegionMaker<Scalar>::ray(bool fat) {
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

template <class Scalar>
ConvexRegion<Scalar> RegionMaker<Scalar>::convex() {
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
    return ConvexRegion<Scalar>(planes,
                                random_.chance(0.3) ? Containment::inside : Containment::touching,
                                random_.chance(0.5) ? Touch::exact : Touch::byPlanes);
}

template <class Scalar>
PositionRegion<Scalar> RegionMaker<Scalar>::positions() {
    const Vector3<Scalar> center = point();
    const Scalar size = (point() - point()).cwiseAbs().maxCoeff();
    const Scalar radius = random_.chance(0.05)  ? hostileNumber<Scalar>(random_)
                          : random_.chance(0.1) ? Scalar(0)
                                                : size * Scalar(random_.logBetween(0.05, 2));
    return {center, radius};
}

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
        const PositionRegion<Scalar> ball = make.positions();
        const CellsRegion<Scalar> cells(ball.center(), ball.radius(), grid.cellSize());
        found += expectLikeBruteForce(grid, proxies, ball);
        found += expectLikeBruteForce(grid, proxies, cells);
        for (const auto& [id, key] : find(grid, ball)) {
            EXPECT_EQ(cells.key(grid.box(id)), 0) << "the estimate never misses";
        }
    }
    return found;
}

template struct QueryCheck<float, BoxRegion<float>>;
template struct QueryCheck<float, SphereRegion<float>>;
template struct QueryCheck<float, RayRegion<float>>;
template struct QueryCheck<float, ConvexRegion<float>>;
template struct QueryCheck<float, PositionRegion<float>>;
template struct QueryCheck<float, CellsRegion<float>>;
template struct QueryCheck<float, MovingBoxRegion<float>>;
template class RegionMaker<float>;
template void expectCellLikeBruteForce(const Grid<float>&, std::span<const Placed<float>>,
                                       const std::array<std::int64_t, 3>&);
template std::size_t expectQueriesLikeBruteForce(const Grid<float>&, std::span<const Placed<float>>,
                                                 Random&, int);

template struct QueryCheck<double, BoxRegion<double>>;
template struct QueryCheck<double, SphereRegion<double>>;
template struct QueryCheck<double, RayRegion<double>>;
template struct QueryCheck<double, ConvexRegion<double>>;
template struct QueryCheck<double, PositionRegion<double>>;
template struct QueryCheck<double, CellsRegion<double>>;
template struct QueryCheck<double, MovingBoxRegion<double>>;
template class RegionMaker<double>;
template void expectCellLikeBruteForce(const Grid<double>&, std::span<const Placed<double>>,
                                       const std::array<std::int64_t, 3>&);
template std::size_t expectQueriesLikeBruteForce(const Grid<double>&,
                                                 std::span<const Placed<double>>, Random&, int);

}  // namespace hashphase::test
