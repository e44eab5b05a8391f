// SPDX-License-Identifier: Zlib

// Which cells have proxies.

#include <broadphase/filed_cells.hpp>
#include <broadphase/pairs.hpp>
#include <tests/support/cell_oracle.hpp>
#include <tests/support/random.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class FiledCellsOf : public testing::Test {
protected:
    using Box = Aabb<Scalar>;

    Box draw(double smallest, double largest) {
        const Vector3<double> low = random.pointIn(-10, 10);
        const Vector3<double> size = random.pointIn(smallest, largest);
        return {low.cast<Scalar>(), (low + size).cast<Scalar>()};
    }
    ProxyId add(const Box& box, Mobility mobility = Mobility::mobile) {
        boxes.push_back(box);
        ids.push_back(grid.add(box, mobility));
        return ids.back();
    }
    void addSome(std::size_t count, double smallest = 0.5, double largest = 2,
                 Mobility mobility = Mobility::mobile) {
        for (std::size_t i = 0; i < count; ++i) {
            add(draw(smallest, largest), mobility);
        }
    }
    FiledCells<Scalar> update() {
        grid.update();
        return filedCells(grid);
    }

    Random random{0x5eedce11};
    Grid<Scalar> grid{GridConfig{.cellSize = 2}};
    std::vector<Box> boxes;
    std::vector<ProxyId> ids;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(FiledCellsOf, Scalars);

TYPED_TEST(FiledCellsOf, NoProxiesAreNone) {
    const FiledCells<TypeParam> found = this->update();
    EXPECT_TRUE(found.cells.empty());
    EXPECT_TRUE(found.unfiled.empty());
}

TYPED_TEST(FiledCellsOf, AGridHoldEachProxyOnceAndAreAsLargeAsConfigured) {
    this->addSome(4000);
    const FiledCells<TypeParam> found = this->update();
    EXPECT_TRUE(found.unfiled.empty());
    EXPECT_GT(found.cells.size(), 900U);
    EXPECT_TRUE(found.cells[0].box.sizes().isApproxToConstant(2, TypeParam(1e-3)));
    expectCellsOf<TypeParam>(this->boxes, found.cells);
}

TYPED_TEST(FiledCellsOf, AThinPopulationReachThroughItAlongAnAxis) {
    this->addSome(600);
    const FiledCells<TypeParam> found = this->update();
    EXPECT_TRUE(found.unfiled.empty());
    EXPECT_GT(found.cells.front().box.sizes().maxCoeff(), 20);
    expectCellsOf<TypeParam>(this->boxes, found.cells);
}

TYPED_TEST(FiledCellsOf, AGridAreListedTheFullestFirst) {
    this->addSome(300);
    for (int i = 0; i < 40; ++i) {
        this->add(this->boxes[7]);
    }
    const FiledCells<TypeParam> found = this->update();
    EXPECT_GE(found.cells.front().load, 41U);
    EXPECT_TRUE(
        std::ranges::is_sorted(found.cells, std::ranges::greater(), &FiledCell<TypeParam>::load));
}

TYPED_TEST(FiledCellsOf, LargerProxiesAreLarger) {
    this->addSome(300);
    const auto small = this->boxes;
    this->boxes.clear();
    this->addSome(100, 4, 7);
    const FiledCells<TypeParam> found = this->update();
    std::vector<FiledCell<TypeParam>> fine;
    std::vector<FiledCell<TypeParam>> coarse;
    for (const FiledCell<TypeParam>& cell : found.cells) {
        (cell.box.sizes().x() < 4 ? fine : coarse).push_back(cell);
    }
    expectCellsOf<TypeParam>(small, fine);
    expectCellsOf<TypeParam>(this->boxes, coarse);
}

TYPED_TEST(FiledCellsOf, RestingProxiesAreNotThoseOfMobileOnes) {
    this->addSome(1000, 0.5, 2, Mobility::resting);
    this->addSome(500);
    for (int i = 0; i < 20; ++i) {
        for (std::size_t k = 1000; k < 1500; ++k) {
            this->boxes[k] = this->draw(0.5, 2);
            this->grid.move(this->ids[k], this->boxes[k]);
        }
        this->grid.update();
    }
    const FiledCells<TypeParam> found = filedCells(this->grid);
    const std::span<const Aabb<TypeParam>> all(this->boxes);
    std::size_t filed = 0;
    for (const FiledCell<TypeParam>& cell : found.cells) {
        EXPECT_TRUE(cell.load == cornersIn(cell.box, all.first(1000)) ||
                    cell.load == cornersIn(cell.box, all.subspan(1000)));
        filed += cell.load;
    }
    EXPECT_EQ(filed, 1500U);
}

TYPED_TEST(FiledCellsOf, AGridLeaveOutWhatIsLargeWhatHasChangedAndWhatIsNaN) {
    this->addSome(200);
    const TypeParam infinity = std::numeric_limits<TypeParam>::infinity();
    const Vector3<TypeParam> corner = Vector3<TypeParam>::Constant(infinity);
    const ProxyId ground = this->grid.add({-corner, corner});
    const ProxyId none = this->grid.add(
        {Vector3<TypeParam>::Constant(std::numeric_limits<TypeParam>::quiet_NaN()), corner});
    EXPECT_EQ(this->update().unfiled, std::vector{ground});
    this->grid.remove(this->ids[0]);
    this->grid.move(this->ids[1], this->boxes[2]);
    this->grid.move(none, this->boxes[3]);
    const ProxyId fresh = this->grid.add(this->boxes[4]);
    const FiledCells<TypeParam> found = filedCells(this->grid);
    std::vector<ProxyId> unfiled{this->ids[1], ground, none, fresh};
    std::ranges::sort(unfiled);
    EXPECT_EQ(found.unfiled, unfiled);
    expectCellsOf<TypeParam>(std::span(this->boxes).subspan(2), found.cells);
}

TYPED_TEST(FiledCellsOf, AGridAreTheSameHoweverOftenTheyAreListed) {
    this->addSome(300);
    this->update();
    for (const ProxyId id : this->ids) {
        this->grid.move(id, this->draw(0.5, 2));
    }
    for (int i = 0; i < 20; ++i) {
        ASSERT_EQ(filedCells(this->grid).unfiled, this->ids) << "no call files what has changed";
    }
    EXPECT_TRUE(this->update().unfiled.empty());
}

TYPED_TEST(FiledCellsOf, FewProxiesAreNone) {
    this->addSome(10);
    const FiledCells<TypeParam> found = this->update();
    EXPECT_TRUE(found.cells.empty());
    EXPECT_EQ(found.unfiled, this->ids);
}

// Those that tremble are filed by a box around where they were.
TYPED_TEST(FiledCellsOf, ProxiesThatTrembleReachOneCellFurtherAtMost) {
    this->addSome(300, 1, 1.5);
    Pairs<TypeParam> pairs(this->grid);
    for (int frame = 0; frame < 100; ++frame) {
        for (std::size_t i = 0; i < this->ids.size(); ++i) {
            auto box = this->boxes[i];
            box.translate(this->random.pointIn(-0.01, 0.01).template cast<TypeParam>());
            this->grid.move(this->ids[i], box);
        }
        pairs.update();
    }
    ASSERT_GT(pairs.lastCost().grid.resting, 200U);
    const FiledCells<TypeParam> found = filedCells(this->grid);
    std::size_t filed = found.unfiled.size();
    EXPECT_LT(filed, 50U);
    for (const FiledCell<TypeParam>& cell : found.cells) {
        const Aabb<TypeParam> reach(cell.box.min(), cell.box.max() + cell.box.sizes());
        const auto isWithin = [&](ProxyId id) { return reach.contains(this->grid.box(id)); };
        EXPECT_GE(std::ranges::count_if(this->ids, isWithin), static_cast<int>(cell.load));
        filed += cell.load;
    }
    EXPECT_EQ(filed, this->ids.size());
}

TYPED_TEST(FiledCellsOf, EqualGridsAreEqual) {
    this->addSome(300);
    const FiledCells<TypeParam> found = this->update();
    Grid<TypeParam> twin({.cellSize = 2});
    for (const auto& box : this->boxes) {
        static_cast<void>(twin.add(box));
    }
    twin.update();
    const FiledCells<TypeParam> again = filedCells(twin);
    ASSERT_EQ(again.cells.size(), found.cells.size());
    for (std::size_t i = 0; i < found.cells.size(); ++i) {
        EXPECT_TRUE(isSameBits(again.cells[i].box, found.cells[i].box));
        EXPECT_EQ(again.cells[i].load, found.cells[i].load);
    }
}

}  // namespace
}  // namespace hashphase::test
