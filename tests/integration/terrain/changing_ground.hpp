// SPDX-License-Identifier: Zlib
#pragma once

// A terrain that changes at random, and what it should be: a list of triangles by number, from which a new
// terrain is built, and the boxes of all that has changed.

#include <integration/terrain/changed_ground.hpp>
#include <tests/integration/terrain/meshes.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace hashphase::test {

template <class Scalar>
class ChangingGround {
public:
    using Point = Vector3<Scalar>;
    using Corners = std::array<Point, 3>;
    using Found = std::optional<Ground<Scalar>>;

    /// Others stand and hang in the same grid.
    ChangingGround(std::uint64_t seed, UpAxis up)
        : random(seed), up_(up), terrain(grid, up), changed(terrain, 100000) {
        for (int i = 0; i < 60; ++i) {
            const Point middle = random.pointIn(-7, 7).template cast<Scalar>();
            others.push_back(grid.add(boxAround<Scalar>(middle, Scalar(0.3))));
        }
    }

    /// One of all changes there are.
    void step() {
        switch (random.below(8)) {
            case 0:
            case 1:
            case 2:
                add(drawTriangles(1 + random.below(24)));
                break;
            case 3:
            case 4:
                removeSome(1 + random.below(20));
                break;
            case 5:
            case 6:
                replaceSome(1 + random.below(6));
                break;
            default:
                random.chance(0.05) ? clear() : random.chance(0.3) ? shift() : update();
                break;
        }
    }

    /// That all numbers are as they should be.
    void expectNumbers() const {
        ASSERT_GE(terrain.size(), known_.size());
        std::size_t goodCount = 0;
        for (std::uint32_t number = 0; number < terrain.size(); ++number) {
            const bool isGood = number < known_.size() && known_[number].isGood;
            goodCount += isGood ? 1 : 0;
            const Corners corners = terrain.corners(number);
            ASSERT_EQ(terrain.proxy(number).isNull(), !isGood);
            if (isGood) {
                ASSERT_EQ(corners, known_[number].corners);
                ASSERT_EQ(terrain.triangleOf(terrain.proxy(number)), number);
                Aabb<Scalar> box(corners[0]);
                box.extend(corners[1]);
                box.extend(corners[2]);
                ASSERT_TRUE(isSameBits(grid.box(terrain.proxy(number)), box));
            } else {
                ASSERT_TRUE(corners[0].hasNaN() && corners[1].hasNaN() && corners[2].hasNaN());
                ASSERT_EQ(terrain.normal(number), Point::Zero());
            }
        }
        ASSERT_EQ(grid.size(), goodCount + others.size());
        for (const ProxyId id : others) {
            ASSERT_FALSE(terrain.triangleOf(id));
        }
    }

    /// That answers are those of a new terrain, triangle for triangle.
    void expectAnswersOfANewOne(int count) {
        Grid<Scalar> newGrid;
        Terrain<Scalar> fresh(newGrid, up_);
        fresh.setSeamTolerance(terrain.seamTolerance(Point::Zero()));
        std::vector<std::uint32_t> numbers;
        std::vector<Point> corners;
        for (std::uint32_t number = 0; number < known_.size(); ++number) {
            if (known_[number].isGood) {
                numbers.push_back(number);
                corners.insert(corners.end(), known_[number].corners.begin(),
                               known_[number].corners.end());
            }
        }
        fresh.add(corners);
        const auto numbered = [&](Found found) {
            if (found) {
                found->triangle = numbers[found->triangle];
            }
            return found;
        };
        for (int i = 0; i < count; ++i) {
            const Point point = drawPoint();
            const auto radius = static_cast<Scalar>(random.chance(0.3) ? 0 : random.unit());
            ASSERT_EQ(terrain.surfaceBelow(point), numbered(fresh.surfaceBelow(point)));
            ASSERT_EQ(terrain.restingHeight(point, radius),
                      numbered(fresh.restingHeight(point, radius)));
        }
    }

    /// That whatever touches what has changed is found, and nothing else.
    void expectStanding(const Grid<Scalar>& bodies, std::span<const ProxyId> ids, Scalar reach) {
        std::vector<ProxyId> expected;
        for (const ProxyId id : ids) {
            const auto touches = [&](const Aabb<Scalar>& box) {
                const Point around = Point::Constant(reach);
                return overlaps(bodies.box(id), {box.min() - around, box.max() + around});
            };
            if (std::any_of(changes_.begin(), changes_.end(), touches)) {
                expected.push_back(id);
            }
        }
        std::sort(expected.begin(), expected.end());
        std::vector<ProxyId> standing{ProxyId{99, 99}};
        changed.findStanding(bodies, reach, standing);
        ASSERT_EQ(standing, expected);
    }
    void forgetChanges() {
        changed.clear();
        changes_.clear();
    }

    /// Near the ground, where the origin is now.
    [[nodiscard]] Point drawPoint() {
        return Point(random.pointIn(-7, 7).template cast<Scalar>()) - shifted_;
    }

    Random random;
    Grid<Scalar> grid;

private:
    UpAxis up_;

public:
    Terrain<Scalar> terrain;
    ChangedGround<Scalar> changed;
    std::vector<ProxyId> others;

private:
    struct Known {
        bool isTaken = false;
        bool isGood = false;
        Corners corners;
    };

    /// Splinters, some of them bad.
    std::vector<Point> drawTriangles(std::uint32_t count) {
        std::vector<Point> corners;
        for (std::uint32_t i = 0; i < count; ++i) {
            const Point middle = drawPoint();
            for (int k = 0; k < 3; ++k) {
                corners.push_back(middle + random.pointIn(-2, 2).template cast<Scalar>());
            }
            if (random.chance(0.1)) {
                corners[3 * i + random.below(3)][random.axis()] =
                    std::numeric_limits<Scalar>::infinity();
            }
        }
        return corners;
    }

    void add(const std::vector<Point>& corners) {
        const auto count = static_cast<std::uint32_t>(corners.size() / 3);
        std::uint32_t first = 0;
        for (std::uint32_t i = 0; i < known_.size() && i - first < count; ++i) {
            first = known_[i].isTaken ? i + 1 : first;
        }
        known_.resize(std::max<std::size_t>(known_.size(), first + count));
        const AddedTriangles added = terrain.add(corners);
        ASSERT_EQ(added.first, first) << "the lowest numbers that are free";
        take(added, first, corners);
    }

    void replaceSome(std::uint32_t most) {
        const auto [first, count] = drawTaken(most);
        std::vector<Point> corners = drawTriangles(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            const Known& known = known_[first + i];
            if (known.isGood && random.chance(0.4)) {  // the same, or only higher
                std::copy(known.corners.begin(), known.corners.end(), corners.begin() + 3 * i);
                const auto rise = static_cast<Scalar>(random.chance(0.5) ? 0 : 0.25);
                for (std::size_t k = 0; k < 3; ++k) {
                    corners[3 * i + k][static_cast<int>(up_)] += rise;
                }
            }
        }
        take(terrain.replace(first, corners), first, corners);
    }

    void take(const AddedTriangles& told, std::uint32_t first, const std::vector<Point>& corners) {
        ASSERT_EQ(told.first, first);
        ASSERT_EQ(told.count, corners.size() / 3);
        std::vector<std::uint32_t> refused;
        for (std::uint32_t i = 0; i < told.count; ++i) {
            Known& known = known_[first + i];
            const Known next{true,
                             corners[3 * i].allFinite() && corners[3 * i + 1].allFinite() &&
                                 corners[3 * i + 2].allFinite(),
                             {corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]}};
            if (!next.isGood) {
                refused.push_back(first + i);
            }
            if (!known.isGood || !next.isGood || known.corners != next.corners) {
                noteChange(known);
                noteChange(next);
            }
            known = next;
        }
        ASSERT_EQ(told.refused, refused);
    }

    void removeSome(std::uint32_t most) {
        const auto [first, count] = drawTaken(most);
        terrain.remove(first, count);
        for (std::uint32_t number = first; number < first + count; ++number) {
            noteChange(known_[number]);
            known_[number] = {};
        }
    }

    /// Numbers in a row that are taken, up to so many.
    std::pair<std::uint32_t, std::uint32_t> drawTaken(std::uint32_t most) {
        const auto first = random.below(static_cast<std::uint32_t>(known_.size()) + 1);
        std::uint32_t count = 0;
        while (count < most && first + count < known_.size() && known_[first + count].isTaken) {
            ++count;
        }
        return {first, count};
    }

    void clear() {
        for (Known& known : known_) {
            noteChange(known);
        }
        terrain.clear();
        known_.clear();
    }

    // By a power of two, so that nothing is rounded away.
    void shift() {
        const Point by = at<Scalar>(16.0 * random.below(5) - 32, 0, 32.0 * random.below(3) - 32);
        grid.shiftOrigin(by);
        terrain.shiftOrigin(by);
        shifted_ += by;
        for (Known& known : known_) {
            for (Point& corner : known.corners) {
                corner -= by;
            }
        }
        for (Aabb<Scalar>& box : changes_) {
            box = {box.min() - by, box.max() - by};
        }
    }

    void update() {
        for (const ProxyId id : others) {
            if (random.chance(0.2)) {
                grid.move(id, boxAround<Scalar>(drawPoint(), Scalar(0.3)));
            }
        }
        grid.update();
    }

    void noteChange(const Known& known) {
        if (known.isGood) {
            Aabb<Scalar> box(known.corners[0]);
            box.extend(known.corners[1]);
            box.extend(known.corners[2]);
            changes_.push_back(box);
        }
    }

    std::vector<Known> known_;  // by number
    std::vector<Aabb<Scalar>> changes_;
    Point shifted_ = Point::Zero();
};

}  // namespace hashphase::test
