// SPDX-License-Identifier: Zlib

// Boxes with infinite ends, also those that lie at infinity, on their ways and beside those of others: met are
// those that firstContact() meets.

#include <broadphase/collectors.hpp>
#include <broadphase/moving_box.hpp>
#include <broadphase/pairs.hpp>
#include <broadphase/sweeps.hpp>
#include <tests/support/oracles.hpp>
#include <tests/support/random.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <limits>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class InfiniteWays : public testing::Test {
protected:
    // Moves along some axes only, or none; also by as much as there is.
    Vector3<Scalar> anyWay() {
        const std::array<Scalar, 8> ways{0, 0, 0, 1, -30, Scalar(1e6), kFar / 64, -kFar / 4};
        Vector3<Scalar> way;
        for (Scalar& component : way) {
            component = ways[random_.below(ways.size())];
        }
        return way;
    }
    Aabb<Scalar> anyBox() {
        constexpr Scalar kEndless = std::numeric_limits<Scalar>::infinity();
        const std::array<Scalar, 8> rare{-kEndless, -kFar,    -kFar / 2, -2,
                                         3,         kFar / 2, kFar,      kEndless};
        Aabb<Scalar> box;
        for (int axis = 0; axis < 3; ++axis) {
            std::array<Scalar, 2> ends{};
            for (Scalar& end : ends) {
                end = random_.chance(0.15) ? rare[random_.below(rare.size())]
                                           : static_cast<Scalar>(random_.below(40));
            }
            if (random_.chance(0.1)) {
                ends[1] = ends[0];  // perhaps at infinity
            }
            box.min()[axis] = std::min(ends[0], ends[1]);
            box.max()[axis] = std::max(ends[0], ends[1]);
        }
        return box;
    }

    /// Everybody stands or sweeps: ways[i] of the proxy ids[i].
    void expectPairsByFirstContact(const Grid<Scalar>& grid, const std::vector<ProxyId>& ids,
                                   const std::vector<MovingBox<Scalar>>& ways,
                                   const Pairs<Scalar>& pairs) {
        std::vector<ProxyPair> expected;
        for (std::size_t i = 0; i < ids.size(); ++i) {
            for (std::size_t k = i + 1; k < ids.size(); ++k) {
                if (firstContact(ways[i], ways[k])) {
                    expected.push_back(makePair(ids[i], ids[k]));
                }
            }
        }
        std::vector<ProxyPair> actual;
        pairs.collect(actual);
        EXPECT_EQ(differences(actual, expected), "");
        EXPECT_EQ(grid.validate(), "");
    }
    void expectQueriesByKeys(const Grid<Scalar>& grid, const std::vector<ProxyId>& ids) {
        const MovingBox<Scalar> way{anyBox(), anyWay()};
        expectFound(grid, ids, MovingBoxRegion<Scalar>(way), [&](const Aabb<Scalar>& box) {
            return firstContact(way, MovingBox<Scalar>{box}).has_value();
        });
        const Vector3<Scalar> from = random_.pointIn(-9, 50).template cast<Scalar>();
        const RayRegion<Scalar> ray(from, from + anyWay() / 64, anyBox());
        expectFound(grid, ids, ray, [&](const Aabb<Scalar>& box) { return ray.key(box) >= 0; });
    }
    template <class Region, class Meets>
    void expectFound(const Grid<Scalar>& grid, const std::vector<ProxyId>& ids,
                     const Region& region, const Meets& meets) {
        std::vector<ProxyId> expected;
        std::ranges::copy_if(ids, std::back_inserter(expected),
                             [&](ProxyId id) { return meets(grid.box(id)); });
        std::vector<ProxyId> found;
        CollectAll all(found);
        grid.visit(region, all);
        std::ranges::sort(found);
        EXPECT_EQ(found, expected);
    }

    // In double precision, contacts are exact up to 1e300.
    static constexpr Scalar kFar =
        sizeof(Scalar) == sizeof(float) ? std::numeric_limits<Scalar>::max() : Scalar(1e150);
    Random random_{0x5eed1f17};
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(InfiniteWays, Scalars);

TYPED_TEST(InfiniteWays, MeetWhatFirstContactMeets) {
    using Scalar = TypeParam;
    const std::array<GridConfig, 3> configs{{{}, {.cellSize = 1, .slack = 0}, {.cellSize = 16}}};
    for (int life = 0; life < 240; ++life) {
        SCOPED_TRACE(life);
        Grid<Scalar> grid(configs[this->random_.below(3)]);
        Sweeps<Scalar> sweeps(grid);
        Pairs<Scalar> pairs(grid, &sweeps);
        const std::uint32_t count = std::array{6U, 40U, 150U}[this->random_.below(3)];
        std::vector<ProxyId> ids;
        std::vector<MovingBox<Scalar>> ways;
        for (std::uint32_t i = 0; i < count; ++i) {
            ways.push_back({this->anyBox()});
            ids.push_back(grid.add(ways.back().box));
        }
        const double sweeping = std::array{0.05, 0.5}[this->random_.below(2)];
        for (int update = 0; update < 3; ++update) {
            for (std::uint32_t i = 0; i < count; ++i) {
                const auto mode = std::array{Sweep::box, Sweep::line, Sweep::automatic,
                                             Sweep::none}[this->random_.below(4)];
                if (this->random_.chance(sweeping)) {
                    sweeps.set(ids[i], MovingBox<Scalar>{this->anyBox(), this->anyWay()}, mode);
                    ways[i] = sweeps.motion(ids[i]);
                }
            }
            pairs.update();
            this->expectPairsByFirstContact(grid, ids, ways, pairs);
            if (this->random_.chance(0.5)) {
                grid.expectRays(1000);  // a tree of boxes in place of cells
            }
            for (int query = 0; query < 10; ++query) {
                this->expectQueriesByKeys(grid, ids);
            }
        }
    }
}

}  // namespace
}  // namespace hashphase::test
