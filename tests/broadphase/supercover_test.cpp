// SPDX-License-Identifier: Zlib

// Rays through thousands of cells, each filled by a box of its own, meet those that a walk in
// rational numbers goes through or touches, and no neighbours of these.

#include <tests/support/query_checks.hpp>
#include <tests/support/ray_oracle.hpp>

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

using UnitCell = std::array<int, 3>;
using UnitCells = std::set<UnitCell>;

/// Which of the closed intervals from i to i + 1 hold the number: one, or on a border two.
std::pair<int, int> intervalsWith(const mpq_class& x) {
    mpz_class floor;
    mpz_fdiv_q(floor.get_mpz_t(), x.get_num_mpz_t(), x.get_den_mpz_t());
    const auto low = static_cast<int>(floor.get_si());
    return {x == low ? low - 1 : low, low};
}

/// Walks from border to border of cells of 1 m, the times of which are exact.
class RationalWalk {
public:
    RationalWalk(const Vector3<double>& from, const Vector3<double>& to) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto at = static_cast<int>(axis);
            from_[axis] = from[at];
            way_[axis] = mpq_class(to[at]) - from_[axis];
            // The border at which it begins, or just passed: crossed at 0, or before.
            const auto [below, above] = intervalsWith(from_[axis]);
            border_[axis] = way_[axis] < 0 ? above + 1 : above;
            step(axis);
        }
    }

    /// The cells that the segment touches, closed.
    UnitCells cells() {
        UnitCells touched;
        mpq_class time = 0;
        while (time < 1) {
            addCellsAt(time, touched);
            time = *std::min_element(crossing_.begin(), crossing_.end());
            for (std::size_t axis = 0; axis < 3; ++axis) {
                if (crossing_[axis] == time) {
                    step(axis);
                }
            }
        }
        addCellsAt(1, touched);
        return touched;
    }

private:
    /// To the next border that is crossed after the start, if not after the end.
    void step(std::size_t axis) {
        crossing_[axis] = 1;
        if (way_[axis] == 0) {
            return;
        }
        do {
            border_[axis] += way_[axis] < 0 ? -1 : 1;
            crossing_[axis] = (border_[axis] - from_[axis]) / way_[axis];
        } while (crossing_[axis] <= 0);
        crossing_[axis] = crossing_[axis] < 1 ? crossing_[axis] : mpq_class(1);
    }

    void addCellsAt(const mpq_class& time, UnitCells& touched) const {
        std::array<std::pair<int, int>, 3> at;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            at[axis] = intervalsWith(from_[axis] + time * way_[axis]);
        }
        for (int x = at[0].first; x <= at[0].second; ++x) {
            for (int y = at[1].first; y <= at[1].second; ++y) {
                for (int z = at[2].first; z <= at[2].second; ++z) {
                    touched.insert({x, y, z});
                }
            }
        }
    }

    std::array<mpq_class, 3> from_;
    std::array<mpq_class, 3> way_;
    std::array<int, 3> border_{};
    std::array<mpq_class, 3> crossing_;
};

/// Those of the cells that are near the end, as many as fit a test, and all cells around them.
UnitCells withNeighbours(const UnitCells& touched, const Vector3<double>& end) {
    constexpr double kReach = 1200;
    UnitCells result;
    for (const UnitCell& cell : touched) {
        if ((Vector3<double>(cell[0], cell[1], cell[2]) - end).cwiseAbs().maxCoeff() > kReach) {
            continue;
        }
        for (int i = 0; i < 27; ++i) {
            result.insert({cell[0] + i % 3 - 1, cell[1] + i / 3 % 3 - 1, cell[2] + i / 9 - 1});
        }
    }
    return result;
}

template <class Scalar>
class RaySupercover : public testing::Test {
protected:
    using Point = Vector3<Scalar>;

    /// The ray through boxes in all cells finds those it touches. Where it passes a cell nearer
    /// than numbers tell, the cell may be found, too. Returns how often that is so.
    static std::size_t expectCells(const Vector3<double>& from, const Vector3<double>& to) {
        const UnitCells touched = RationalWalk(from, to).cells();
        const UnitCells cells = withNeighbours(touched, to);
        GridConfig config;
        config.cellSize = 1;
        Grid<Scalar> grid(config);
        for (const UnitCell& cell : cells) {
            const auto mobility =
                (cell[0] + cell[1]) % 3 == 0 ? Mobility::resting : Mobility::mobile;
            static_cast<void>(grid.add(boxOf(cell), mobility));
        }
        grid.update();
        const RayRegion<Scalar> ray(from.cast<Scalar>(), to.cast<Scalar>());
        CollectKeys<Scalar> alone;
        grid.visit(ray, alone);
        CollectKeys<Scalar> together;
        grid.visitEach(std::span(&ray, 1), std::span(&together, 1));
        EXPECT_EQ(differences(together.sorted(), alone.sorted()), "");

        std::size_t nearMisses = 0;
        std::size_t index = 0;
        std::size_t next = 0;
        std::size_t met = 0;
        const auto found = alone.sorted();
        for (const UnitCell& cell : cells) {
            const bool isFound = next < found.size() && found[next].first.index == index;
            const bool isTouched = touched.contains(cell);
            next += isFound ? 1 : 0;
            met += isTouched ? 1 : 0;
            ++index;
            EXPECT_TRUE(isFound || !isTouched) << describe(cell);
            if (isFound && !isTouched) {
                ++nearMisses;
                const Aabb<Scalar> wide =
                    withDoubt<Scalar>(boxOf(cell), ray.from(), ray.from(), kDoubt);
                EXPECT_TRUE(meetsByRationals(ray.from(), Point(to.cast<Scalar>()), wide))
                    << describe(cell);
            }
        }
        EXPECT_EQ(next, found.size());
        EXPECT_GT(met, 1000U);
        EXPECT_GT(cells.size(), 4 * met);
        return nearMisses;
    }

private:
    static constexpr double kDoubt =
        8 * static_cast<double>(std::numeric_limits<Scalar>::epsilon());

    static Aabb<Scalar> boxOf(const UnitCell& cell) {
        const Point low = Vector3<int>(cell[0], cell[1], cell[2]).cast<Scalar>();
        return {low, low + Point::Ones()};
    }
    static testing::Message describe(const UnitCell& cell) {
        return testing::Message() << "cell " << cell[0] << ", " << cell[1] << ", " << cell[2];
    }
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(RaySupercover, Scalars);

TYPED_TEST(RaySupercover, IsWhatIsFoundAlongAxesOnBordersOfCells) {
    EXPECT_EQ(this->expectCells({0, 3, 5}, {1200, 3, 5}), 0U) << "in edges";
    EXPECT_EQ(this->expectCells({7, 0.25, -2.5}, {7, -1200, -2.5}), 0U) << "in faces";
    EXPECT_EQ(this->expectCells({7.5, 0.25, 600}, {7.5, 0.25, -600}), 0U) << "between them";
}

TYPED_TEST(RaySupercover, IsWhatIsFoundAlongDiagonals) {
    EXPECT_EQ(this->expectCells({0, 0, 0}, {500, 500, 500}), 0U) << "through corners";
    EXPECT_EQ(this->expectCells({300, -300, 5}, {-300, 300, 5}), 0U) << "through edges, in faces";
    EXPECT_EQ(this->expectCells({0.5, 0, 0.25}, {-499.5, 500, -499.75}), 0U) << "through faces";
}
TYPED_TEST(RaySupercover, IsWhatIsFoundInOtherDirections) {
    EXPECT_EQ(this->expectCells({-3, 9, 1}, {1021, 649, -383}), 0U) << "through some corners";
    EXPECT_EQ(this->expectCells({0.25, 0.5, 0.75}, {1200.25, 1.5, 1}), 0U) << "nearly in faces";
    EXPECT_EQ(this->expectCells({0.375, 0.125, -7}, {-811.5, 402.125, 737.25}), 0U) << "any";
}

// Who adds up steps is 98 cells off there.
TYPED_TEST(RaySupercover, IsWhatIsFoundAtTheEndOfAHundredThousandCells) {
    EXPECT_EQ(this->expectCells({1e5, 0, 0}, {0, 0, 1e5}), 0U);
    const std::size_t nearMisses =
        this->expectCells({0.125, 0.5, -0.25}, {-1e5, 2500.5, 41'250.25});
    EXPECT_LE(nearMisses, sizeof(TypeParam) == sizeof(float) ? 200U : 0U) << "of 13,841 cells";
}

}  // namespace
}  // namespace hashphase::test
