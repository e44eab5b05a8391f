// SPDX-License-Identifier: Zlib

// The grid's cells in Bullet's debug drawing.

#include <broadphase/filed_cells.hpp>
#include <integration/bullet/conversions.hpp>
#include <integration/bullet/debug_draw.hpp>
#include <integration/bullet/detail/sequential_ramp.hpp>
#include <tests/support/cell_oracle.hpp>
#include <tests/support/random.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <limits>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

const btVector3 kMobileColour(btScalar(0.34), btScalar(0.71), btScalar(0.91));
const btVector3 kRestingColour(btScalar(0.66), btScalar(0.69), btScalar(0.75));
const btVector3 kUnfiledColour(btScalar(0.84), btScalar(0.37), btScalar(0));

constexpr std::size_t kLinesOfABox = 12;

struct DrawnLine {
    btVector3 from;
    btVector3 to;
    btVector3 colour;
};

struct DrawnBox {
    Aabb<btScalar> box;
    btVector3 colour;
};

/// Keeps what is drawn.
class RecordingDrawer final : public btIDebugDraw {
public:
    std::vector<DrawnBox> boxes;
    std::vector<DrawnLine> lines;
    std::size_t linesAtLastFlush = 0;

    void drawAabb(const btVector3& from, const btVector3& to, const btVector3& colour) override {
        boxes.push_back({toAabb(from, to), colour});
        btIDebugDraw::drawAabb(from, to, colour);  // by lines, whose ends are rounded
    }
    void drawLine(const btVector3& from, const btVector3& to, const btVector3& colour) override {
        lines.push_back({from, to, colour});
    }
    void flushLines() override { linesAtLastFlush = lines.size(); }
    void drawContactPoint(const btVector3&, const btVector3&, btScalar, int,
                          const btVector3&) override {}
    void reportErrorWarning(const char*) override {}
    void draw3dText(const btVector3&, const char*) override {}
    void setDebugMode(int) override {}
    [[nodiscard]] int getDebugMode() const override { return DBG_NoDebug; }
};

/// Expects the twelve edges of the box.
void expectEdges(std::span<const DrawnLine> lines, const DrawnBox& drawn) {
    std::set<std::pair<int, int>> edges;  // by the numbers of their corners
    for (const DrawnLine& line : lines) {
        EXPECT_EQ(line.colour, drawn.colour);
        const auto cornerAt = [&](const btVector3& point) {
            int corner = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const bool isHigh = point[axis] > drawn.box.center()[axis];
                const btScalar side = isHigh ? drawn.box.max()[axis] : drawn.box.min()[axis];
                EXPECT_NEAR(point[axis], side, 1e-4);
                corner |= isHigh ? 1 << axis : 0;
            }
            return corner;
        };
        const auto [low, high] = std::minmax({cornerAt(line.from), cornerAt(line.to)});
        EXPECT_EQ(std::popcount(static_cast<unsigned>(low ^ high)), 1);
        edges.emplace(low, high);
    }
    EXPECT_EQ(edges.size(), kLinesOfABox);
}

btVector3 colourOf(float share) {
    const auto [red, green, blue] = detail::sequentialRgb(share);
    return btVector3(btScalar(red), btScalar(green), btScalar(blue)) / btScalar(255);
}

SpatialHashConfig cellsOfTwoMetres() {
    SpatialHashConfig config;
    config.grid.cellSize = 2;
    return config;
}

class DrawingCells : public testing::Test {
protected:
    btBroadphaseProxy* add(const Aabb<btScalar>& box,
                           int group = btBroadphaseProxy::DefaultFilter) {
        return broadphase.createProxy(toBullet(box.min()), toBullet(box.max()), BOX_SHAPE_PROXYTYPE,
                                      nullptr, group, btBroadphaseProxy::AllFilter, nullptr);
    }
    Aabb<btScalar> draw() {
        const Vector3<double> low = random.pointIn(-8, 8);
        const Vector3<double> size = random.pointIn(0.5, 2);
        return {low.cast<btScalar>(), (low + size).cast<btScalar>()};
    }
    void addSome(std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            boxes.push_back(draw());
            add(boxes.back());
        }
    }
    std::vector<DrawnBox> drawAll(const CellDrawing& options = {}) {
        drawer = {};
        drawn = drawCells(broadphase, drawer, options);
        EXPECT_EQ(drawn.lines, drawer.lines.size());
        EXPECT_EQ(drawer.linesAtLastFlush, drawer.lines.size());
        EXPECT_EQ(drawer.lines.size(), kLinesOfABox * drawer.boxes.size());
        for (std::size_t i = 0; i < drawer.boxes.size(); ++i) {
            expectEdges(std::span(drawer.lines).subspan(i * kLinesOfABox, kLinesOfABox),
                        drawer.boxes[i]);
        }
        return drawer.boxes;
    }
    /// With the loads that they have by brute force.
    std::vector<FiledCell<btScalar>> cellsAt(std::span<const DrawnBox> all) {
        std::vector<FiledCell<btScalar>> cells;
        for (const DrawnBox& each : all) {
            cells.push_back({each.box, cornersIn<btScalar>(each.box, boxes)});
        }
        return cells;
    }

    Random random{0x5eedd4a0};
    SpatialHashBroadphase broadphase{cellsOfTwoMetres()};
    std::vector<Aabb<btScalar>> boxes;
    RecordingDrawer drawer;
    DrawnCells drawn;
};

TEST_F(DrawingCells, DrawsEachCellThatHoldsTheLeastCornerOfABox) {
    addSome(300);
    broadphase.calculateOverlappingPairs(nullptr);
    const std::vector<FiledCell<btScalar>> cells = cellsAt(drawAll());
    expectCellsOf<btScalar>(boxes, cells);
    EXPECT_NEAR(cells.front().box.sizes().minCoeff(), 2, 1e-3);
    EXPECT_EQ(drawn.cells, cells.size());
    EXPECT_EQ(drawn.unfiled, 0U);
    EXPECT_EQ(drawn.linesLeftOut, 0U);
}

TEST_F(DrawingCells, ColoursACellByItsLoadOfEight) {
    for (int i = 0; i < 1000; ++i) {  // a lattice, and the corner of it twice
        const Vector3<btScalar> place(btScalar(i % 10), btScalar(i / 10 % 10), btScalar(i / 100));
        boxes.push_back(hashphase::boxAround<btScalar>(place * btScalar(2.1), btScalar(0.5)));
        add(boxes.back());
    }
    boxes.push_back(boxes.front());
    add(boxes.back());
    broadphase.calculateOverlappingPairs(nullptr);
    const std::vector<DrawnBox> all = drawAll();
    const std::vector<FiledCell<btScalar>> cells = cellsAt(all);
    ASSERT_GE(cells.front().load, 2U);
    ASSERT_LE(cells.front().load, 8U);
    for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_EQ(all[i].colour, colourOf(static_cast<float>(cells[i].load) / 8));
    }
}

TEST_F(DrawingCells, ColoursTheFullestCellYellowAndTheOthersByIt) {
    addSome(200);
    for (int i = 0; i < 30; ++i) {
        boxes.push_back(boxes[3]);
        add(boxes.back());
    }
    broadphase.calculateOverlappingPairs(nullptr);
    const std::vector<DrawnBox> all = drawAll();
    const std::vector<FiledCell<btScalar>> cells = cellsAt(all);
    EXPECT_GE(drawn.largestLoad, 31U);
    EXPECT_EQ(all.front().colour, btVector3(254, 232, 56) / btScalar(255));
    for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_EQ(all[i].colour, colourOf(static_cast<float>(cells[i].load) /
                                          static_cast<float>(drawn.largestLoad)));
    }
}

TEST_F(DrawingCells, DrawsNoMoreLinesThanAllowedAndTheFullestCellsFirst) {
    addSome(300);
    broadphase.calculateOverlappingPairs(nullptr);
    const std::vector<DrawnBox> all = drawAll();
    for (const std::size_t mostLines : {std::size_t{0}, 5 * kLinesOfABox, 6 * kLinesOfABox - 1}) {
        const std::vector<DrawnBox> first = drawAll({.mostLines = mostLines});
        ASSERT_EQ(first.size(), mostLines / kLinesOfABox);
        for (std::size_t i = 0; i < first.size(); ++i) {
            EXPECT_TRUE(isSameBits(first[i].box, all[i].box));
        }
        EXPECT_EQ(drawn.cells, all.size());
        EXPECT_EQ(drawn.linesLeftOut, kLinesOfABox * (all.size() - first.size()));
    }
}

TEST_F(DrawingCells, DrawsTheBoxOfAProxyInNoCell) {
    addSome(100);
    const auto ground = boxBetween<btScalar>({-50, -1, -50}, {50, 0, 50});
    add(ground, btBroadphaseProxy::StaticFilter);
    broadphase.calculateOverlappingPairs(nullptr);
    const std::vector<DrawnBox> all = drawAll();
    EXPECT_EQ(drawn.unfiled, 1U);
    ASSERT_EQ(all.size(), drawn.cells + 1);
    EXPECT_TRUE(all.back().box.isApprox(ground));
    EXPECT_EQ(all.back().colour, kUnfiledColour);
}

TEST_F(DrawingCells, DrawsTheBoxesOfAllProxiesIfAsked) {
    addSome(100);
    std::vector<Aabb<btScalar>> fixed;
    for (int i = 0; i < 500; ++i) {
        fixed.push_back(draw());
        add(fixed.back(), btBroadphaseProxy::StaticFilter);
    }
    btBroadphaseProxy* const wide = add(boxBetween<btScalar>({0, 0, 0}, {1, 1, 1}));
    broadphase.setMargin(wide, btScalar(0.25), nullptr);
    boxes.push_back(boxBetween<btScalar>({-0.25F, -0.25F, -0.25F}, {1.25F, 1.25F, 1.25F}));
    for (int i = 0; i < 3; ++i) {  // while others move, those that are fixed come to rest
        boxes[1].translate(Vector3<btScalar>(btScalar(0.1), 0, 0));
        broadphase.setAabb(broadphase.proxyOf(broadphase.grid().idAt(1)), toBullet(boxes[1].min()),
                           toBullet(boxes[1].max()), nullptr);
        broadphase.calculateOverlappingPairs(nullptr);
    }
    const std::vector<DrawnBox> all = drawAll({.boxes = true});
    ASSERT_EQ(all.size(), drawn.cells + 601);
    const auto expectDrawn = [&](const Aabb<btScalar>& box, const btVector3& colour) {
        EXPECT_EQ(std::ranges::count_if(std::span(all).subspan(drawn.cells),
                                        [&](const DrawnBox& each) {
                                            return each.box.isApprox(box, btScalar(1e-4)) &&
                                                   each.colour == colour;
                                        }),
                  1);
    };
    for (const Aabb<btScalar>& box : boxes) {
        expectDrawn(box, kMobileColour);
    }
    for (const Aabb<btScalar>& box : fixed) {
        expectDrawn(box, kRestingColour);
    }
}

TEST_F(DrawingCells, DrawsNothingThatIsInfiniteOrNaN) {
    const btScalar infinity = std::numeric_limits<btScalar>::infinity();
    add({Vector3<btScalar>::Constant(-infinity), Vector3<btScalar>::Constant(0)});
    add({Vector3<btScalar>::Constant(std::numeric_limits<btScalar>::quiet_NaN()),
         Vector3<btScalar>::Constant(0)});
    EXPECT_TRUE(drawAll({.boxes = true}).empty());
    EXPECT_EQ(drawn.unfiled, 1U);
    EXPECT_EQ(drawn.linesLeftOut, 0U);
}

}  // namespace
}  // namespace hashphase::test
