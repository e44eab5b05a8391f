// SPDX-License-Identifier: Zlib

// Boxes of numbers that have broken broadphases: huge, infinite, NaN, inverted, of both zeroes, on
// the borders of cells as these are rounded, and where numbers are sparser than boxes.

#include <broadphase/search/join.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/fill_table.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/pair_world.hpp>
#include <tests/support/query_checks.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class HardNumbers : public testing::Test {
protected:
    using Boxes = std::vector<Aabb<Scalar>>;

    /// A unit box at the origin, but for one axis.
    static Aabb<Scalar> along(std::uint32_t axis, Scalar low, Scalar high) {
        Aabb<Scalar> box = makeBox<Scalar>(0, 0, 0, 1, 1, 1);
        box.min()[axis] = low;
        box.max()[axis] = high;
        return box;
    }

    static GridConfig cellsOf(double size) {
        GridConfig config;
        config.cellSize = size;
        return config;
    }

    /// A cube of 4 x 4 x 4 unit boxes, each of which touches its neighbours, as rounded.
    static void addLattice(Boxes& boxes, const Vector3<double>& at) {
        for (int i = 0; i < 64; ++i) {
            const Vector3<double> low = at + Vector3<double>(i % 4, i / 4 % 4, i / 16);
            const Vector3<double> high = (low.array() + 1).matrix();
            boxes.emplace_back(low.cast<Scalar>(), high.cast<Scalar>());
        }
    }
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(HardNumbers, Scalars);

TYPED_TEST(HardNumbers, BeyondAllCellsAreComparedAsTheyAre) {
    const CaughtMessages messages;
    using Limits = std::numeric_limits<TypeParam>;
    typename TestFixture::Boxes boxes(40, makeBox<TypeParam>(0, 0, 0, 1, 1, 1));
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
        for (const TypeParam far : {TypeParam(3e9), TypeParam(1e18), Limits::max(),
                                    Limits::infinity(), Limits::quiet_NaN()}) {
            for (const TypeParam x : {far, -far}) {
                boxes.push_back(this->along(axis, x, x));
                boxes.push_back(this->along(axis, x - 1, x + 1));
                boxes.push_back(
                    this->along(axis, std::min<TypeParam>(x, 0), std::max<TypeParam>(x, 0)));
            }
            boxes.push_back(this->along(axis, -far, far));
        }
    }
    for (const double cellSize : {1.0, 0.0, 1e-30, 1e30}) {
        EXPECT_GT(expectPairsOfBruteForce<TypeParam>(boxes, this->cellsOf(cellSize)), 2000U);
        ASSERT_FALSE(this->HasFatalFailure()) << cellSize;
    }

    Grid<TypeParam> grid(this->cellsOf(1));
    std::vector<Placed<TypeParam>> proxies;
    for (const Aabb<TypeParam>& box : boxes) {
        proxies.push_back({grid.add(box), box});
    }
    for (const Aabb<TypeParam>& box : boxes) {
        expectLikeBruteForce<TypeParam>(grid, proxies, BoxRegion<TypeParam>{box});
    }
}

TYPED_TEST(HardNumbers, OfABoxWithNanChangeNothingForTheOthers) {
    Random random(0x5eed1001);
    const BoxScene<TypeParam> scene = spreadScene<TypeParam>("", 1, 0);
    std::vector<std::vector<ProxyPair>> born;
    for (int field = -1; field < 6; ++field) {
        const CaughtMessages messages;
        Random same(0x5eed1002);
        Grid<TypeParam> grid;
        Pairs<TypeParam> pairs(grid);
        for (int i = 0; i < 200; ++i) {
            static_cast<void>(grid.add(scene.draw(same)));
        }
        if (field >= 0) {
            Aabb<TypeParam> box = makeBox<TypeParam>(-9, -9, -9, 9, 9, 9);
            (field < 3 ? box.min() : box.max())[field % 3] =
                std::numeric_limits<TypeParam>::quiet_NaN();
            static_cast<void>(grid.add(box));
        }
        const auto changes = pairs.update([](ProxyId, ProxyId) { return true; });
        born.emplace_back(changes.born.begin(), changes.born.end());
        EXPECT_EQ(grid.nanCount(), field >= 0 ? 1U : 0U);
        EXPECT_EQ(messages.all().size(), grid.nanCount()) << "reported";
    }
    EXPECT_GT(born[0].size(), 100U);
    for (const std::vector<ProxyPair>& list : born) {
        EXPECT_EQ(differences(list, born[0]), "");
    }
}

// Among them the empty box, which is inverted as far as numbers go.
TYPED_TEST(HardNumbers, OfInvertedBoxesMeanWhatComparingThemSays) {
    using Bounds = Aabb<TypeParam>;
    const Bounds inside = makeBox<TypeParam>(2, 2, 2, 1, 1, 1);
    std::vector<Bounds> boxes{Bounds(), inside, makeBox<TypeParam>(2, 1, 1, 1, 2, 2)};
    for (int i = 0; i < 40; ++i) {
        boxes.push_back(inside);
        boxes.push_back(makeBox<TypeParam>(i, 0, 0, i + 1, 3, 3));
    }
    for (const double cellSize : {0.0, 1.0, 100.0}) {
        EXPECT_GT(expectPairsOfBruteForce<TypeParam>(boxes, this->cellsOf(cellSize)), 39U);
    }
    // They end before they begin where many, sorted along that axis, share a cell.
    for (int i = 0; i < 400; ++i) {
        boxes.push_back(makeBox<TypeParam>(0.1 * i, 0, 0, 0.1 * i + 0.05, 3, 3));
    }
    boxes.push_back(makeBox<TypeParam>(30, 0, 0, 10, 1, 1));
    boxes.push_back(makeBox<TypeParam>(10, 0, 0, 9.97, 1, 1));
    EXPECT_GT(expectPairsOfBruteForce<TypeParam>(boxes, this->cellsOf(100)), 100U);

    PairWorld<TypeParam> world;
    world.add(inside);
    world.add(inside);
    world.add(Bounds());
    world.add(makeBox<TypeParam>(-9, -9, -9, 9, 9, 9));
    EXPECT_EQ(world.update().born.size(), 2U) << "with what they lie within, not with each other";
}

// More of them share a cell than are searched unsorted.
TYPED_TEST(HardNumbers, OfBothZeroesAreOneNumber) {
    using Bounds = Aabb<TypeParam>;
    constexpr TypeParam kZeroes[] = {TypeParam(0), -TypeParam(0)};
    for (const int copies : {1, 20}) {
        std::vector<Bounds> boxes;
        for (int i = 0; i < 16 * copies; ++i) {
            Vector3<TypeParam> corner;
            for (int axis = 0; axis < 3; ++axis) {
                corner[axis] = kZeroes[(i >> axis) & 1];
            }
            const bool isBelow = (i & 8) != 0;
            const Vector3<TypeParam> away = Vector3<TypeParam>::Constant(isBelow ? -1 : 1);
            boxes.push_back(isBelow ? Bounds(away, corner) : Bounds(corner, away));
        }
        const std::size_t all = boxes.size() * (boxes.size() - 1) / 2;
        for (const double cellSize : {0.0, 1.0, 0.3, 100.0}) {
            EXPECT_EQ(expectPairsOfBruteForce<TypeParam>(boxes, this->cellsOf(cellSize)), all);
        }
    }
    PairWorld<TypeParam> world;
    const ProxyId id = world.add(makeBox<TypeParam>(-1, -1, -1, 0, 0, 0));
    world.add(makeBox<TypeParam>(0, 0, 0, 1, 1, 1));
    EXPECT_EQ(world.update().born.size(), 1U);
    world.move(id,
               Bounds(Vector3<TypeParam>(-1, -1, -1), Vector3<TypeParam>::Constant(-TypeParam(0))));
    const PairChanges changes = world.update();
    EXPECT_EQ(changes.born.size() + changes.died.size(), 0U);
}

/// What joins find, and what there is, summed up so that order does not matter.
struct PairSum {
    std::uint64_t count = 0;
    std::uint64_t hash = 0;

    void add(std::uint32_t a, std::uint32_t b) {
        std::uint64_t key = (std::uint64_t{std::min(a, b)} << 32 | std::max(a, b)) + 1;
        key *= 0x9e3779b97f4a7c15U;
        key ^= key >> 29;
        ++count;
        hash += key * 0xbf58476d1ce4e5b9U;
    }
    friend bool operator==(const PairSum&, const PairSum&) = default;
};

/// A border of cells of a size, k * cell as rounded, and the numbers next to it.
template <class Scalar>
std::array<Scalar, 3> atBorder(int k, Scalar cell) {
    using Limits = std::numeric_limits<Scalar>;
    const Scalar border = static_cast<Scalar>(k) * cell;
    return {std::nextafter(border, -Limits::infinity()), border,
            std::nextafter(border, Limits::infinity())};
}

/// Boxes from each border to the next along the axis, for k from -1000 to 1000, and points an ulp
/// before and behind each border, in the order of where they begin; and some points at 0, which is
/// their median, where cells are counted from.
template <class Scalar>
std::vector<Aabb<Scalar>> boxesOnBorders(Scalar cell, int axis) {
    std::vector<Aabb<Scalar>> boxes;
    const auto add = [&](Scalar low, Scalar high) {
        boxes.emplace_back(Vector3<Scalar>::Unit(axis) * low, Vector3<Scalar>::Unit(axis) * high);
    };
    for (int k = -1000; k <= 1000; ++k) {
        const auto [below, border, above] = atBorder(k, cell);
        add(below, below);
        for (int i = 0; i < 20 && k == 0; ++i) {
            add(0, 0);
        }
        add(border, static_cast<Scalar>(k + 1) * cell);
        add(above, above);
    }
    return boxes;
}

/// The pairs of boxes that are in the order of where they begin along an axis.
template <class Scalar>
PairSum pairsInOrder(const std::vector<Aabb<Scalar>>& boxes) {
    PairSum pairs;
    for (std::uint32_t a = 0; a < boxes.size(); ++a) {
        for (std::uint32_t b = a + 1; b < boxes.size() && overlaps(boxes[a], boxes[b]); ++b) {
            pairs.add(a, b);
        }
    }
    return pairs;
}

/// The level counts its cells from 0, and in order; numbers at border k are in cell k or the one
/// before. Returns how many borders themselves are not in cell k.
template <class Scalar>
std::size_t expectCellsAtBorders(const detail::Level<Scalar>& level, Scalar size, int axis) {
    const auto at = static_cast<std::size_t>(axis);
    EXPECT_EQ(level.origin[at], 0);
    std::size_t elsewhere = 0;
    std::int32_t last = -1001;
    for (int k = -1000; k <= 1000; ++k) {
        const std::array<Scalar, 3> numbers = atBorder(k, size);
        for (const Scalar x : numbers) {
            const std::int32_t cell = level.cell(x, at);
            EXPECT_TRUE(last <= cell && k - 1 <= cell && cell <= k) << x << " is in " << cell;
            last = cell;
        }
        elsewhere += level.cell(numbers[1], at) != k ? 1 : 0;
    }
    return elsewhere;
}

/// For cells of so many tenths of a metre, the pairs are those that touch. Returns how many borders
/// are not in the cell that begins there.
template <class Scalar>
std::size_t expectNoneParted(int tenths, int axis) {
    SCOPED_TRACE(testing::Message() << tenths << " tenths of a metre along axis " << axis);
    const auto cell = static_cast<Scalar>(0.1 * tenths);
    const std::vector<Aabb<Scalar>> boxes = boxesOnBorders(cell, axis);
    detail::Table<Scalar> table;
    fill(table, boxes, detail::fixedLevels(0.1 * tenths, 4));
    EXPECT_GT(table.levels()[0].count(), boxes.size() / 2) << "others are rounded to larger ones";
    const std::size_t elsewhere = expectCellsAtBorders(table.levels()[0], cell, axis);
    detail::PairParts parts;
    detail::PairList found;
    detail::KernelCost cost;
    detail::joinTable(table, serialFor, parts, found, cost);
    PairSum actual;
    for (const auto [first, second] : found.pairs()) {
        actual.add(table.proxyIndex(first), table.proxyIndex(second));
    }
    EXPECT_EQ(actual, pairsInOrder(boxes));
    EXPECT_GE(actual.count, 3 * 2000U);
    return elsewhere;
}

// For cells of 0.1, 0.2 ... 100: 2001 borders of each at both sides of 0, and the numbers next to
// them. A good tenth of the borders are rounded into the cell before.
TYPED_TEST(HardNumbers, OnTheBordersOfAMillionCellsPartNoBoxes) {
    std::size_t elsewhere = 0;
    for (int tenths = 1; tenths <= 500 && !this->HasFailure(); ++tenths) {
        elsewhere += expectNoneParted<TypeParam>(tenths, 0);
    }
    EXPECT_GT(elsewhere, 100'000U);
}

TYPED_TEST(HardNumbers, OnTheBordersOfAMillionCellsAbove50MetresPartNoBoxes) {
    std::size_t elsewhere = 0;
    for (int tenths = 501; tenths <= 1000 && !this->HasFailure(); ++tenths) {
        elsewhere += expectNoneParted<TypeParam>(tenths, 0);
    }
    EXPECT_GT(elsewhere, 100'000U);
}

TYPED_TEST(HardNumbers, OnTheBordersOfAHundredThousandCellsAlongOtherAxesPartNoBoxes) {
    std::size_t elsewhere = 0;
    for (int tenths = 1; tenths <= 1000 && !this->HasFailure(); tenths += 8) {
        elsewhere += expectNoneParted<TypeParam>(tenths, 1 + tenths / 8 % 2);
    }
    EXPECT_GT(elsewhere, 10'000U);
}

// Where numbers are two apart, boxes grow to their neighbours' neighbours, or to nothing.
TYPED_TEST(HardNumbers, SparserThanBoxesMissNoPair) {
    for (const double far : {0x1p24, 1e7, 0x1p25 + 2, 1e8, 1e9, -0x1p24, -1e9}) {
        typename TestFixture::Boxes boxes;
        this->addLattice(boxes, {far, 0, 0});
        this->addLattice(boxes, {far + 3, far, 0});
        this->addLattice(boxes, {far + 3, far + 3, far + 3});
        for (const double cellSize : {0.0, 1.0, 0.7}) {
            EXPECT_GT(expectPairsOfBruteForce<TypeParam>(boxes, this->cellsOf(cellSize)), 3 * 144U);
            ASSERT_FALSE(this->HasFatalFailure()) << far << " in cells of " << cellSize;
        }
    }
}

// Two corners of the world make any other layout of cells than a hash impossible.
TYPED_TEST(HardNumbers, OfCellsBeyond32BitsAreCellsLikeOthers) {
    typename TestFixture::Boxes boxes;
    for (int corner = 0; corner < 8; ++corner) {
        Vector3<double> at;
        for (int axis = 0; axis < 3; ++axis) {
            at[axis] = ((corner >> axis) & 1) != 0 ? 0x1p31 - 2 : -0x1p31 - 2;
        }
        this->addLattice(boxes, at);
    }
    this->addLattice(boxes, {0, 0, 0});
    for (const double cellSize : {1.0, 0.0, 0.25}) {
        EXPECT_GE(expectPairsOfBruteForce<TypeParam>(boxes, this->cellsOf(cellSize)), 9 * 144U);
        ASSERT_FALSE(this->HasFatalFailure()) << cellSize;
    }

    Grid<TypeParam> grid(this->cellsOf(1));
    for (const double x : {0x1p31, -0x1p31, 0x1p40, -0x1p40}) {
        const ProxyId id =
            grid.add(this->along(2, static_cast<TypeParam>(x), static_cast<TypeParam>(x)));
        EXPECT_EQ(grid.cellsOf(id).lowest[2], static_cast<std::int64_t>(x));
        EXPECT_EQ(grid.cellsOf(id).highest[2], static_cast<std::int64_t>(x));
        CollectCount count;
        grid.visitCell({0, 0, static_cast<std::int64_t>(x)}, count);
        EXPECT_EQ(count.count(), 1U) << x;
    }
    EXPECT_EQ(
        grid.cellAt(Vector3<TypeParam>(TypeParam(1e30), TypeParam(-1e30), 0)),
        (std::array<std::int64_t, 3>{9'000'000'000'000'000'000, -9'000'000'000'000'000'000, 0}));
}

}  // namespace
}  // namespace hashphase::test
