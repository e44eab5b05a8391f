// SPDX-License-Identifier: Zlib

// The grid, its queries, and who is near whom, against a look at everything.

#include <broadphase/cells_region.hpp>
#include <broadphase/moving_box.hpp>
#include <broadphase/neighbours.hpp>
#include <broadphase/position_region.hpp>
#include <broadphase/radius_search.hpp>
#include <integration/ai/nearest.hpp>
#include <tests/fuzz/grid_world.hpp>
#include <tests/support/neighbour_oracle.hpp>
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
        life_.play(operation, *this, kAsking);
        expectHolds<Scalar>(world_.grid, life_.proxies(), life_.dead());
        const auto everything = Vector3<Scalar>::Constant(std::numeric_limits<Scalar>::infinity());
        expectFinds(BoxRegion<Scalar>{{-everything, everything}});
        EXPECT_LE(world_.grid.indexLimit(), 2 * kMostProxies) << "of what is, and was last filed";
    }

private:
    void update(Arguments& arguments) {
        if (isNeverUpdated_) {
            story_.tell("nothing");
            return;
        }
        story_.tell("update");
        world_.grid.update(anyFor(arguments));
    }

    void releaseReserveOrClear(Arguments& arguments) {
        if (arguments.byte() % 2 == 1) {
            world_.grid.releaseUnusedMemory();
            story_.tell("release unused memory; ");
        }
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
        story_.tell("box ", region.box);
        expectLikeBruteForce(world_.grid, life_.proxies(), region);
    }

    void askBall(Arguments& arguments) {
        const std::uint32_t form = arguments.below(3);
        const Vector3<Scalar> center = life_.palette().point(arguments);
        const Scalar reach = radius(arguments);
        story_.tell("ball ", form, ' ', center, ", ", reach);
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
        story_.tell("ray ", ray.from(), " by ", ray.direction());
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
        story_.tell("moving box ", box, way);
        expectFinds(MovingBoxRegion<Scalar>({box, way}));
    }

    void askCells(Arguments& arguments) {
        const Placed<Scalar>& proxy = life_.proxies()[life_.any(arguments)];
        if (!proxy.box.min().allFinite() || !proxy.box.max().allFinite()) {
            story_.tell("no cells");
            return;
        }
        const CellRange range = world_.grid.cellsOf(proxy.id);
        const std::array<std::int64_t, 3> cell = arguments.flag() ? range.lowest : range.highest;
        story_.tell("cell ", cell[0], ", ", cell[1], ", ", cell[2], " of ", proxy.id.index);
        expectCellLikeBruteForce(world_.grid, life_.proxies(), cell);
    }

    void askNeighbours(Arguments& arguments) {
        const Scalar distance = radius(arguments);
        story_.tell("neighbours within ", distance);
        expectNeighboursLikeBruteForce(neighbours_.find(world_.grid, distance, anyFor(arguments)),
                                       life_.proxies(), distance);
    }

    void askCrowd(Arguments& arguments) {
        const Scalar reach = radius(arguments);
        story_.tell("crowd within ", reach);
        search_.take(world_.grid, reach, acceptAll, anyFor(arguments));
        EXPECT_EQ(neighbourLists(search_), neighboursByBruteForce(life_.proxies(), reach));
        EXPECT_EQ(search_.size() + search_.leftOutCount(), life_.proxies().size());
    }

    void askNearest(Arguments& arguments) {
        const Vector3<Scalar> point = life_.palette().point(arguments);
        const std::size_t count = arguments.below(12);
        const Scalar farthest =
            arguments.flag() ? std::numeric_limits<Scalar>::infinity() : radius(arguments);
        story_.tell("the nearest ", count, " to ", point, " within ", farthest);
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

    void askBoxesTogether(Arguments& arguments) {
        askTogether<BoxRegion<Scalar>>(arguments, &GridModel::boxRegion);
    }
    void askRaysTogether(Arguments& arguments) {
        askTogether<RayRegion<Scalar>>(arguments, &GridModel::rayRegion);
    }
    template <class Region>
    void askTogether(Arguments& arguments, Region (GridModel::*make)(Arguments&)) {
        const std::uint32_t count = 1 + arguments.below(24);
        Random random = arguments.random();
        story_.tell(count, " regions at once");
        std::vector<Region> regions;
        for (std::uint32_t i = 0; i < count; ++i) {
            const Operation drawn = drawOperation(random);
            Arguments from(drawn);
            regions.push_back((this->*make)(from));
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

    static constexpr std::array<void (GridModel::*)(Arguments&), 18> kAsking{
        &GridModel::update,
        &GridModel::update,
        &GridModel::update,
        &GridModel::rest,
        &GridModel::releaseReserveOrClear,
        &GridModel::askBox,
        &GridModel::askBall,
        &GridModel::askRay,
        &GridModel::askRay,
        &GridModel::askConvex,
        &GridModel::askMovingBox,
        &GridModel::askCells,
        &GridModel::askNeighbours,
        &GridModel::askCrowd,
        &GridModel::askNearest,
        &GridModel::askBoxesTogether,
        &GridModel::askRaysTogether,
        &GridModel::askCollectors};

    OperationLog& story_;
    GridWorld<Scalar> world_;
    BoxModel<Scalar, GridWorld<Scalar>> life_;
    bool isNeverUpdated_;
    Neighbours<Scalar> neighbours_;
    RadiusSearch<Scalar> search_;
};

}  // namespace

Verdict playGrid(std::span<const Operation> operations, bool tellsStory) {
    return playInEither<GridModel>(operations, tellsStory);
}

}  // namespace hashphase::test
