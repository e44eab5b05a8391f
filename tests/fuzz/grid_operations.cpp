// SPDX-License-Identifier: Zlib

// The grid, its queries, and who is near whom, against a look at everything.

#include <broadphase/cells_region.hpp>
#include <broadphase/moving_box.hpp>
#include <broadphase/neighbours.hpp>
#include <broadphase/position_region.hpp>
#include <broadphase/radius_search.hpp>
#include <integration/ai/nearest.hpp>
#include <tests/fuzz/grid_world.hpp>
#include <tests/fuzz/subjects.hpp>
#include <tests/support/position_oracles.hpp>
#include <tests/support/radius_oracle.hpp>

namespace hashphase::test {
namespace {

template <class Scalar>
class GridModel {
public:
    GridModel(const Operation& first, OperationLog& story)
        : story_(story),
          world_(configOf(first)),
          life_(first, world_, story),
          isNeverUpdated_(first.arguments[7] % 4 == 3) {}

    void play(const Operation& operation) {
        Arguments arguments(operation);
        constexpr std::uint32_t kAsking = 18;
        const std::uint32_t kind = operation.kind % (life_.kKinds + kAsking);
        if (kind < life_.kKinds || life_.proxies().empty()) {
            life_.change(kind, arguments);
        } else {
            ask(kind - life_.kKinds, arguments);
        }
        expectHolds<Scalar>(world_.grid, life_.proxies(), life_.dead());
        const auto everything = Vector3<Scalar>::Constant(std::numeric_limits<Scalar>::infinity());
        expectFinds(BoxRegion<Scalar>{{-everything, everything}});
        EXPECT_LE(world_.grid.indexLimit(), 2 * kMostProxies) << "of what is, and was last filed";
    }

private:
    void ask(std::uint32_t kind, Arguments& arguments) {
        switch (kind) {
            case 0:
            case 1:
            case 2:
                update(arguments);
                break;
            case 3:
                rest(arguments);
                break;
            case 4: {
                if (arguments.byte() % 2 == 1) {
                    world_.grid.releaseUnusedMemory();
                    story_.tell("release unused memory; ");
                }
                reserveOrClear(arguments);
                break;
            }
            case 5:
                askBox(arguments);
                break;
            case 6:
                askBall(arguments);
                break;
            case 7:
            case 8:
                askRay(arguments);
                break;
            case 9:
                askConvex(arguments);
                break;
            default:
                askMany(kind, arguments);
                break;
        }
    }

    void askMany(std::uint32_t kind, Arguments& arguments) {
        switch (kind) {
            case 10:
                askMovingBox(arguments);
                break;
            case 11:
                askCells(arguments);
                break;
            case 12:
                askNeighbours(arguments);
                break;
            case 13:
                askCrowd(arguments);
                break;
            case 14:
                askNearest(arguments);
                break;
            case 15:
                askTogether<BoxRegion<Scalar>>(
                    arguments, [this](Arguments& from) { return this->boxRegion(from); });
                break;
            case 16:
                askTogether<RayRegion<Scalar>>(
                    arguments, [this](Arguments& from) { return this->rayRegion(from); });
                break;
            default:
                askCollectors(arguments);
                break;
        }
    }

    void update(Arguments& arguments) {
        if (isNeverUpdated_) {
            story_.tell("nothing");
            return;
        }
        story_.tell("update");
        world_.grid.update(anyFor(arguments));
    }

    void reserveOrClear(Arguments& arguments) {
        const std::uint32_t count = arguments.byte();
        if (arguments.flag()) {
            life_.clear();
        } else {
            world_.grid.reserve(count);
            story_.tell("reserve");
        }
    }

    void rest(Arguments& arguments) {
        if (isNeverUpdated_) {
            story_.tell("nothing");
            return;
        }
        const std::uint32_t updates = 1 + arguments.below(12);
        story_.tell(updates, " updates");
        for (std::uint32_t i = 0; i < updates; ++i) {
            world_.grid.update();
        }
    }

    template <class Region>
    void expectFinds(const Region& region) {
        CollectKeys<Scalar> expected;
        visitByBruteForce(life_.proxies(), region, expected);
        EXPECT_EQ(differences(find(world_.grid, region), expected.sorted()), "");
    }

    BoxRegion<Scalar> boxRegion(Arguments& arguments) {
        return {life_.palette().box(arguments, life_.proxies())};
    }
    RayRegion<Scalar> rayRegion(Arguments& arguments) {
        const std::uint8_t form = arguments.byte();
        const Vector3<Scalar> from = life_.palette().point(arguments);
        Vector3<Scalar> to = life_.palette().point(arguments);
        if (form % 4 == 1) {
            to = from;
        } else if (form % 4 == 2) {  // along an axis
            const auto axis = static_cast<int>(form / 4 % 3);
            const Scalar end = to[axis];
            to = from;
            to[axis] = end;
        } else if (form % 16 == 3) {
            to[form / 16 % 3] = Palette<Scalar>::hostile(arguments.byte());
        }
        if (form < 128) {
            return {from, to};
        }
        const auto half = Vector3<Scalar>::Constant(life_.palette().extent(arguments.byte()));
        return {from, to, {-half, half}};
    }
    Scalar radius(Arguments& arguments) {
        const std::uint8_t byte = arguments.byte();
        return byte >= 224 ? Palette<Scalar>::hostile(arguments.byte())
                           : life_.palette().extent(byte);
    }

    void askBox(Arguments& arguments) {
        const BoxRegion<Scalar> region = boxRegion(arguments);
        story_.tell("box ", story_.isTold() ? textOf(region.box) : std::string());
        expectLikeBruteForce(world_.grid, life_.proxies(), region);
    }

    void askBall(Arguments& arguments) {
        const std::uint32_t form = arguments.below(3);
        const Vector3<Scalar> center = life_.palette().point(arguments);
        const Scalar reach = radius(arguments);
        story_.tell("ball ", form, ' ', story_.isTold() ? textOf(center) : std::string(), ", ",
                    reach);
        if (form == 0) {
            expectLikeBruteForce(world_.grid, life_.proxies(), SphereRegion<Scalar>(center, reach));
        } else if (form == 1) {
            expectFinds(PositionRegion<Scalar>(center, reach));
        } else {
            expectFinds(CellsRegion<Scalar>(center, reach, world_.grid.cellSize()));
        }
    }

    void askRay(Arguments& arguments) {
        const RayRegion<Scalar> ray = rayRegion(arguments);
        story_.tell("ray ", story_.isTold() ? textOf(ray.from()) : std::string(), " by ",
                    story_.isTold() ? textOf(ray.direction()) : std::string());
        expectLikeBruteForce(world_.grid, life_.proxies(), ray);
    }

    void askConvex(Arguments& arguments) {
        Random random = arguments.random();
        RegionMaker<Scalar> make(random, life_.proxies());
        story_.tell("convex volume");
        expectLikeBruteForce(world_.grid, life_.proxies(), make.convex());
    }

    void askMovingBox(Arguments& arguments) {
        const Aabb<Scalar> box = life_.palette().box(arguments, life_.proxies());
        const Vector3<Scalar> way = life_.palette().point(arguments) - box.min();
        story_.tell("moving box ", story_.isTold() ? textOf(box) + textOf(way) : std::string());
        expectFinds(MovingBoxRegion<Scalar>({box, way}));
    }

    // By the definition: floor(coordinate / cell size).
    void askCells(Arguments& arguments) {
        const Placed<Scalar>& proxy = life_.proxies()[life_.any(arguments)];
        if (!proxy.box.min().allFinite() || !proxy.box.max().allFinite()) {
            story_.tell("no cells");
            return;
        }
        const CellRange range = world_.grid.cellsOf(proxy.id);
        const std::array<std::int64_t, 3> cell = arguments.flag() ? range.lowest : range.highest;
        story_.tell("cell ", cell[0], ", ", cell[1], ", ", cell[2], " of ", proxy.id.index);
        std::vector<std::pair<ProxyId, Scalar>> expected;
        for (const Placed<Scalar>& other : life_.proxies()) {
            if (!other.box.min().allFinite() || !other.box.max().allFinite()) {
                continue;
            }
            const CellRange cells = world_.grid.cellsOf(other.id);
            EXPECT_EQ(cells.lowest, world_.grid.cellAt(other.box.min()));
            bool isIn = true;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                isIn =
                    isIn && cells.lowest[axis] <= cell[axis] && cell[axis] <= cells.highest[axis];
            }
            if (isIn) {
                expected.emplace_back(other.id, Scalar(0));
            }
        }
        std::sort(expected.begin(), expected.end());
        CollectKeys<Scalar> found;
        world_.grid.visitCell(cell, found);
        EXPECT_EQ(differences(found.sorted(), expected), "");
    }

    // What is surely near, and what may be by rounding, in higher precision.
    void askNeighbours(Arguments& arguments) {
        const Scalar distance = radius(arguments);
        story_.tell("neighbours within ", distance);
        const auto pairs = neighbours_.find(world_.grid, distance, anyFor(arguments));
        std::vector<ProxyPair> found(pairs.begin(), pairs.end());
        std::sort(found.begin(), found.end());
        EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end()) << "each once";
        std::vector<ProxyPair> surely;
        std::vector<ProxyPair> perhaps;
        forEachPair([&](const Placed<Scalar>& a, const Placed<Scalar>& b) {
            const long double apart = gapBetween(a.box, b.box);
            const auto slack = static_cast<long double>(8 * std::numeric_limits<Scalar>::epsilon() *
                                                        static_cast<double>(apart));
            const auto reach = static_cast<long double>(distance);
            const auto least =
                static_cast<long double>(4 * std::numeric_limits<Scalar>::denorm_min());
            if (apart == 0 ? reach >= 0 : apart + slack + least <= reach) {
                surely.push_back(makePair(a.id, b.id));
            }
            if (reach >= 0 && apart - slack - least <= reach) {
                perhaps.push_back(makePair(a.id, b.id));
            }
        });
        std::sort(surely.begin(), surely.end());
        std::sort(perhaps.begin(), perhaps.end());
        EXPECT_TRUE(std::includes(found.begin(), found.end(), surely.begin(), surely.end()))
            << differences(found, surely);
        EXPECT_TRUE(std::includes(perhaps.begin(), perhaps.end(), found.begin(), found.end()))
            << differences(found, perhaps);
    }

    // Inverted boxes have no straight line between them, and are left out.
    template <class Visit>
    void forEachPair(const Visit& visit) {
        const auto proxies = life_.proxies();
        for (std::size_t i = 0; i < proxies.size(); ++i) {
            for (std::size_t k = i + 1; k < proxies.size(); ++k) {
                if (!hasNan(proxies[i].box) && !hasNan(proxies[k].box)) {
                    visit(proxies[i], proxies[k]);
                }
            }
        }
    }
    static long double gapBetween(const Aabb<Scalar>& a, const Aabb<Scalar>& b) {
        std::array<long double, 3> gaps{};
        for (int axis = 0; axis < 3; ++axis) {
            const auto gap = [axis](const Aabb<Scalar>& low, const Aabb<Scalar>& high) {
                // Both at the same infinity are no distance apart.
                return low.max()[axis] == high.min()[axis]
                           ? 0.0L
                           : static_cast<long double>(high.min()[axis]) -
                                 static_cast<long double>(low.max()[axis]);
            };
            gaps[static_cast<std::size_t>(axis)] = std::max({0.0L, gap(a, b), gap(b, a)});
        }
        return std::hypot(gaps[0], gaps[1], gaps[2]);
    }

    void askCrowd(Arguments& arguments) {
        const Scalar reach = radius(arguments);
        story_.tell("crowd within ", reach);
        search_.take(world_.grid, reach, acceptAll, anyFor(arguments));
        const NeighbourLists expected = neighboursByBruteForce(life_.proxies(), reach);
        ASSERT_EQ(search_.size(), expected.size());
        EXPECT_EQ(search_.size() + search_.leftOutCount(), life_.proxies().size());
        std::vector<std::uint32_t> counts(search_.size());
        search_.count(counts);
        NeighbourLists found;
        search_.forEach([&](std::uint32_t agent, std::span<const std::uint32_t> neighbours) {
            std::vector<ProxyId>& list = found[search_.id(agent)];
            for (const std::uint32_t other : neighbours) {
                list.push_back(search_.id(other));
            }
            std::sort(list.begin(), list.end());
            EXPECT_EQ(counts[agent], neighbours.size());
        });
        EXPECT_EQ(found, expected);
    }

    void askNearest(Arguments& arguments) {
        const Vector3<Scalar> point = life_.palette().point(arguments);
        const std::size_t count = arguments.below(12);
        const Scalar farthest =
            arguments.flag() ? std::numeric_limits<Scalar>::infinity() : radius(arguments);
        story_.tell("the nearest ", count, " to ", story_.isTold() ? textOf(point) : std::string(),
                    " within ", farthest);
        std::vector<KeyedProxy<Scalar>> nearest;
        std::vector<KeyedProxy<Scalar>> expected;
        const auto isEven = [](ProxyId id) { return id.index % 2 == 0; };
        const bool isFiltered = arguments.flag();
        findNearest(world_.grid, point, count, farthest, nearest,
                    isFiltered ? ProxyFilter(isEven) : ProxyFilter(acceptAll));
        findNearestByBruteForce(life_.proxies(), point, count, farthest, expected,
                                isFiltered ? ProxyFilter(isEven) : ProxyFilter(acceptAll));
        EXPECT_EQ(nearest, expected);
    }

    template <class Region, class Make>
    void askTogether(Arguments& arguments, const Make& make) {
        const std::uint32_t count = 1 + arguments.below(24);
        Random random = arguments.random();
        story_.tell(count, " regions at once");
        std::vector<Region> regions;
        for (std::uint32_t i = 0; i < count; ++i) {
            Operation drawn;
            for (std::uint8_t& byte : drawn.arguments) {
                byte = static_cast<std::uint8_t>(random.below(256));
            }
            Arguments from(drawn);
            regions.push_back(make(from));
        }
        std::vector<CollectKeys<Scalar>> found(count);
        world_.grid.visitEach(std::span<const Region>(regions), std::span(found),
                              anyFor(arguments));
        for (std::uint32_t i = 0; i < count; ++i) {
            CollectKeys<Scalar> expected;
            visitByBruteForce(life_.proxies(), regions[i], expected);
            EXPECT_EQ(differences(found[i].sorted(), expected.sorted()), "") << "region " << i;
        }
    }

    void askCollectors(Arguments& arguments) {
        const Vector3<Scalar> center = life_.palette().point(arguments);
        const SphereRegion<Scalar> ball(center, radius(arguments));
        const std::size_t count = arguments.below(10);
        story_.tell("all, bits, and the nearest ", count, " of a ball");
        CollectKeys<Scalar> keys;
        visitByBruteForce(life_.proxies(), ball, keys);

        std::vector<ProxyId> all;
        CollectAll collectAll(all);
        world_.grid.visit(ball, collectAll);
        std::vector<std::uint64_t> bits;
        CollectBits collectBits(bits);
        world_.grid.visit(ball, collectBits);
        std::sort(all.begin(), all.end());
        std::vector<ProxyId> expected;
        std::vector<KeyedProxy<Scalar>> expectedNearest;
        std::size_t bitCount = 0;
        for (const auto& [id, key] : keys.sorted()) {
            expected.push_back(id);
            expectedNearest.push_back({key, id});
            EXPECT_TRUE(id.index / 64 < bits.size() &&
                        (bits[id.index / 64] >> (id.index % 64) & 1) != 0);
        }
        for (const std::uint64_t word : bits) {
            bitCount += static_cast<std::size_t>(std::popcount(word));
        }
        EXPECT_EQ(differences(all, expected), "");
        EXPECT_EQ(bitCount, expected.size());

        std::vector<KeyedProxy<Scalar>> nearest;
        CollectNearest<Scalar> collectNearest(count, nearest);
        world_.grid.visit(ball, collectNearest);
        collectNearest.sort();
        std::sort(expectedNearest.begin(), expectedNearest.end());
        expectedNearest.resize(std::min(expectedNearest.size(), count));
        EXPECT_EQ(nearest, expectedNearest);
    }

    OperationLog& story_;
    GridWorld<Scalar> world_;
    BoxModel<Scalar, GridWorld<Scalar>> life_;
    bool isNeverUpdated_;
    Neighbours<Scalar> neighbours_;
    RadiusSearch<Scalar> search_;
};

}  // namespace

Verdict playGrid(std::span<const Operation> operations, bool tellsStory) {
    return operations.empty() || operations[0].kind % 2 == 0
               ? playLife<GridModel<float>>(operations, tellsStory)
               : playLife<GridModel<double>>(operations, tellsStory);
}

}  // namespace hashphase::test
