// SPDX-License-Identifier: Zlib
#include <integration/mpi/distributed_grid.hpp>
#include <tests/integration/distributed/rank_scenes.hpp>
#include <tests/integration/mpi/ranks_here.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

/// All that the ranks have, on every rank, sorted.
template <class Item>
std::vector<Item> joined(const std::vector<Item>& mine) {
    const int bytes = static_cast<int>(mine.size() * sizeof(Item));
    std::vector<int> counts(static_cast<std::size_t>(rankCount()));
    MPI_Allgather(&bytes, 1, MPI_INT, counts.data(), 1, MPI_INT, MPI_COMM_WORLD);
    std::vector<int> places(counts.size());
    int sum = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        places[i] = sum;
        sum += counts[i];
    }
    std::vector<Item> all(static_cast<std::size_t>(sum) / sizeof(Item));
    MPI_Allgatherv(mine.data(), bytes, MPI_BYTE, all.data(), counts.data(), places.data(), MPI_BYTE,
                   MPI_COMM_WORLD);
    std::sort(all.begin(), all.end());
    return all;
}

struct NamedBox {
    GlobalId object;
    std::array<float, 6> corners{};

    friend auto operator<=>(const NamedBox&, const NamedBox&) = default;
    [[nodiscard]] Aabb<float> box() const {
        return {Vector3<float>(corners.data()), Vector3<float>(corners.data() + 3)};
    }
};

/// The pairs of what lives on all ranks, sorted.
std::vector<GlobalPair> pairsByBruteForce(const RankGrid<float>& here) {
    std::vector<NamedBox> mine;
    here.forEachOwned([&](ProxyId id, const Aabb<float>& box) {
        mine.push_back(
            {here.globalId(id),
             {box.min()[0], box.min()[1], box.min()[2], box.max()[0], box.max()[1], box.max()[2]}});
    });
    const std::vector<NamedBox> all = joined(mine);
    std::vector<GlobalPair> pairs;
    for (std::size_t i = 0; i < all.size(); ++i) {
        for (std::size_t j = i + 1; j < all.size(); ++j) {
            if (overlaps(all[i].box(), all[j].box())) {
                pairs.push_back({all[i].object, all[j].object});
            }
        }
    }
    return pairs;
}

/// The same population in one grid on every rank, and over all ranks.
template <class Scalar>
class SharedWorld {
public:
    using Boxes = MovingBoxes<Scalar>;

    SharedWorld(typename Boxes::Kind kind, std::size_t count, const DistributedConfig& config)
        : grid(MPI_COMM_WORLD, config), boxes_(kind, count, 7), wholePairs_(whole_) {
        for (std::size_t i = 0; i < count; ++i) {
            names_.push_back(GlobalId{i});
            wholeIds_.push_back(whole_.add(boxes_.boxes[i]));
            if (static_cast<int>(i * 7 % static_cast<std::size_t>(rankCount())) == rankHere()) {
                grid.add(names_[i], boxes_.boxes[i]);
            }
        }
    }

    void advance() {
        boxes_.advance();
        for (std::size_t i = 0; i < boxes_.boxes.size(); ++i) {
            whole_.move(wholeIds_[i], boxes_.boxes[i]);
            const ProxyId id = grid.here().find(names_[i]);
            if (!id.isNull() && grid.here().isOwned(id)) {
                grid.move(id, boxes_.boxes[i]);
            }
        }
    }

    void updateAndCheck() {
        const RankChanges changes = grid.update();
        const PairChanges expected = wholePairs_.update();
        EXPECT_EQ(named(expected.born), joined(hereNamed(changes.pairs.born)));
        EXPECT_EQ(named(expected.died), joined(hereNamed(changes.pairs.died)));
        std::vector<GlobalPair> mine;
        grid.here().collect(mine);
        std::vector<ProxyPair> pairs;
        wholePairs_.collect(pairs);
        const std::vector<GlobalPair> all = named(pairs);
        EXPECT_EQ(all, joined(mine));
        PairSum sum;
        for (const GlobalPair& pair : all) {
            sum.add(pair);
        }
        EXPECT_EQ(sum, grid.pairSum());
        EXPECT_EQ("", grid.here().validate());
    }

    void checkQueries(std::uint64_t seed) {
        Random random(seed + static_cast<std::uint64_t>(rankHere()));
        std::vector<Question<Scalar>> questions;
        const std::size_t count = random.below(20);  // other numbers on other ranks
        while (questions.size() < count) {
            const Vector3<Scalar> at = randomPlace(random);
            const Vector3<Scalar> to = randomPlace(random);
            const std::uint32_t most = random.chance(0.5) ? ~0U : random.below(6);
            const auto size = static_cast<Scalar>(random.logBetween(0.01, 30));
            switch (random.below(3)) {
                case 0:
                    questions.push_back(Question<Scalar>::box({at, at.array() + size}, most));
                    break;
                case 1:
                    questions.push_back(Question<Scalar>::sphere(at, size, most));
                    break;
                default:
                    questions.push_back(Question<Scalar>::ray(at, to, most));
            }
        }
        const Answers<Scalar> answers = grid.ask(questions);
        ASSERT_EQ(count + 1, answers.begins.size());
        for (std::size_t i = 0; i < count; ++i) {
            const auto expected = wholeAnswer(questions[i]);
            const auto found = answers.of(i);
            ASSERT_EQ(expected.size(), found.size()) << "question " << i;
            for (std::size_t j = 0; j < found.size(); ++j) {
                EXPECT_EQ(expected[j].first, found[j].key);
                EXPECT_EQ(expected[j].second, found[j].object);
                const auto& box = boxes_.boxes[found[j].object.value];
                EXPECT_EQ(grid.here().partition().rankOf(box.min()), found[j].home);
            }
        }
    }

    DistributedGrid<Scalar> grid;

private:
    Vector3<Scalar> randomPlace(Random& random) const {
        const auto& box =
            boxes_.boxes[random.below(static_cast<std::uint32_t>(boxes_.boxes.size()))];
        return (box.min().template cast<double>() + random.pointIn(-2, 2)).template cast<Scalar>();
    }

    [[nodiscard]] std::vector<GlobalPair> named(std::span<const ProxyPair> pairs) const {
        std::vector<GlobalPair> named;
        for (const ProxyPair& pair : pairs) {  // added in the order of their names
            named.push_back({GlobalId{pair.first.index}, GlobalId{pair.second.index}});
        }
        std::sort(named.begin(), named.end());
        return named;
    }
    [[nodiscard]] std::vector<GlobalPair> hereNamed(std::span<const ProxyPair> pairs) const {
        std::vector<GlobalPair> named;
        for (const ProxyPair& pair : pairs) {
            named.push_back(grid.here().globalPair(pair));
        }
        return named;
    }

    std::vector<std::pair<Scalar, GlobalId>> wholeAnswer(const Question<Scalar>& question) const {
        std::vector<std::pair<Scalar, GlobalId>> found;
        const auto look = [&](const auto& region) {
            for (std::size_t i = 0; i < boxes_.boxes.size(); ++i) {
                const Scalar key = region.key(boxes_.boxes[i]);
                if (key >= 0) {
                    found.push_back({key, names_[i]});
                }
            }
        };
        switch (question.shape) {
            case Question<Scalar>::Shape::box:
                look(BoxRegion<Scalar>{question.extent});
                break;
            case Question<Scalar>::Shape::sphere:
                look(SphereRegion<Scalar>(question.from, question.radius));
                break;
            case Question<Scalar>::Shape::ray:
                look(RayRegion<Scalar>(question.from, question.to, question.extent));
        }
        std::sort(found.begin(), found.end());
        found.resize(std::min<std::size_t>(found.size(), question.most));
        return found;
    }

    Boxes boxes_;
    Grid<Scalar> whole_;
    Pairs<Scalar> wholePairs_;
    std::vector<ProxyId> wholeIds_;
    std::vector<GlobalId> names_;
};

template <class Scalar>
void checkAllKinds(std::size_t count, int frames) {
    using Boxes = MovingBoxes<Scalar>;
    for (const auto kind : Boxes::kKinds) {
        SCOPED_TRACE(Boxes::nameOf(kind));
        SharedWorld<Scalar> world(kind, count, {});
        for (int frame = 0; frame < frames; ++frame) {
            SCOPED_TRACE(frame);
            if (frame > 0) {
                world.advance();
            }
            world.updateAndCheck();
            world.checkQueries(static_cast<std::uint64_t>(frame));
        }
    }
}

TEST(DistributedGrid, EqualsOneGridInEveryFrame) {
    checkAllKinds<float>(3000, 30);
}

TEST(DistributedGrid, EqualsOneGridInDoublePrecision) {
    checkAllKinds<double>(500, 10);
}

// Runs a loop in parts, from the last to the first.
void backwards(std::size_t count, std::size_t /*grain*/, LoopBody body) {
    constexpr std::size_t kParts = 3;
    for (std::size_t part = kParts; part-- > 0;) {
        const std::size_t begin = count * part / kParts;
        const std::size_t end = count * (part + 1) / kParts;
        if (begin < end) {
            body(begin, end);
        }
    }
}

// Each rank removes and adds objects of its own, and writes into payloads what all can compute.
TEST(DistributedGrid, CarriesPayloadsOfObjectsThatComeAndGo) {
    DistributedConfig config;
    config.rankGrid.payloadBytes = 16;
    DistributedGrid<float> grid(MPI_COMM_WORLD, config);
    Random random(static_cast<std::uint64_t>(rankHere()));
    std::uint64_t next = static_cast<std::uint64_t>(rankHere()) << 32;
    const auto write = [&](ProxyId id, std::uint64_t frame) {
        const std::array<std::uint64_t, 2> payload{grid.here().globalId(id).value, frame};
        std::memcpy(grid.payload(id).data(), payload.data(), sizeof(payload));
    };
    for (std::uint64_t frame = 0; frame < 30; ++frame) {
        for (int i = 0; i < 40; ++i) {
            const Vector3<float> at = random.pointIn(0, 20).cast<float>();
            write(grid.add(GlobalId{next++}, Aabb<float>(at, at.array() + 1)), frame);
        }
        grid.here().forEachOwned([&](ProxyId id, const Aabb<float>& box) {
            const Vector3<float> by = random.pointIn(-0.5, 0.5).cast<float>();
            if (random.chance(0.1)) {
                grid.remove(id);
            } else if (random.chance(0.7)) {
                grid.move(id, Aabb<float>(box.min() + by, box.max() + by));
                write(id, frame);
            }
        });
        grid.update(backwards);
        EXPECT_EQ("", grid.here().validate());
        grid.here().grid().forEach([&](ProxyId id, const Aabb<float>&) {
            std::array<std::uint64_t, 2> payload{};
            std::memcpy(payload.data(), grid.here().readPayload(id).data(), sizeof(payload));
            EXPECT_EQ(grid.here().globalId(id).value, payload[0]);
            EXPECT_LE(payload[1], frame);
        });
        std::vector<GlobalPair> mine;
        grid.here().collect(mine);
        const std::vector<GlobalPair> all = joined(mine);
        if (frame % 6 == 0) {
            EXPECT_EQ(pairsByBruteForce(grid.here()), all);
        }
    }
}

TEST(DistributedGrid, IsCutAgainWhenARankAsksForIt) {
    DistributedConfig config;
    config.rebalanceAbove = std::numeric_limits<double>::infinity();
    SharedWorld<float> world(MovingBoxes<float>::Kind::uniform, 1000, config);
    std::vector<bool> cuts;
    for (int frame = 0; frame < 5; ++frame) {
        if (frame == 2 && rankHere() == rankCount() - 1) {
            world.grid.balanceNow();
        }
        world.updateAndCheck();
        cuts.push_back(world.grid.lastCost().wasRebalanced);
        world.advance();
    }
    const bool isShared = rankCount() > 1;
    EXPECT_EQ(std::vector<bool>({isShared, false, false, isShared, false}), cuts);
}

TEST(DistributedGrid, EqualsOneGridWhereMessagesAreSentInPieces) {
    detail::SparseExchange::setLongestMessage(100);
    checkAllKinds<float>(300, 8);
    detail::SparseExchange::setLongestMessage(std::size_t{1} << 30);
}

// By counters: in the tenth frame at the latest, and from then on.
TEST(DistributedGrid, SharesTheWorkOfClusters) {
    using Boxes = MovingBoxes<float>;
    SharedWorld<float> world(Boxes::Kind::clustered, 80'000, {});
    for (int frame = 0; frame < 25; ++frame) {
        world.grid.update();
        world.advance();
        // That of the frame before this one, unless objects were moving.
        static bool wasCut = false;
        if (frame > 10 && !wasCut) {
            EXPECT_LT(world.grid.lastCost().imbalance, 1.15) << frame;
        }
        wasCut = world.grid.lastCost().wasRebalanced;
    }
}

TEST(DistributedGrid, TakesTheLoadThatItIsTold) {
    if (rankCount() == 1) {
        GTEST_SKIP() << "One rank has nothing to share.";
    }
    SharedWorld<float> world(MovingBoxes<float>::Kind::uniform, 4000, {});
    const float middle = std::cbrt(4000.F);
    std::array<double, 2> counts{};  // of objects on this rank, to either side of the middle
    for (int frame = 0; frame < 12; ++frame) {
        world.updateAndCheck();
        counts = {};
        world.grid.here().grid().forEach([&](ProxyId id, const Aabb<float>& box) {
            counts[box.min()[0] < middle ? 0 : 1] += world.grid.here().isOwned(id) ? 1 : 0;
        });
        // To the left an object costs ten times as much.
        world.grid.setLoad(10 * counts[0] + counts[1]);
        world.advance();
    }
    EXPECT_LT(world.grid.lastCost().imbalance, 1.15);
    MPI_Allreduce(MPI_IN_PLACE, counts.data(), 2, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    EXPECT_EQ(4000, counts[0] + counts[1]);
}

// Each pair adds one to both of its objects; all that is found for ghosts comes home.
TEST(DistributedGrid, SendsHomeWhatIsFoundForGhosts) {
    SharedWorld<float> world(MovingBoxes<float>::Kind::log_sizes, 2000, {});
    for (int frame = 0; frame < 5; ++frame) {
        world.updateAndCheck();
        const RankGrid<float>& here = world.grid.here();
        std::vector<std::uint64_t> counts(here.grid().indexLimit());
        here.forEachPair([&](const ProxyPair& pair) {
            ++counts[pair.first.index];
            ++counts[pair.second.index];
        });
        std::vector<Contribution> forGhosts;
        here.grid().forEach([&](ProxyId id, const Aabb<float>&) {
            if (!here.isOwned(id)) {
                forGhosts.push_back({id, std::as_bytes(std::span(&counts[id.index], 1))});
            }
        });
        for (const Contribution& one : world.grid.sendHome(forGhosts)) {
            std::uint64_t more = 0;
            ASSERT_EQ(sizeof(more), one.bytes.size());
            std::memcpy(&more, one.bytes.data(), sizeof(more));
            counts[one.proxy.index] += more;
        }
        // Of both objects of every pair: twice as many as there are pairs.
        std::uint64_t sum = 0;
        here.forEachOwned([&](ProxyId id, const Aabb<float>&) { sum += counts[id.index]; });
        MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD);
        EXPECT_EQ(2 * world.grid.pairSum().count, sum);
        world.advance();
    }
}

TEST(DistributedGrid, DoesOtherWorkBetweenBeginAndEnd) {
    SharedWorld<float> world(MovingBoxes<float>::Kind::uniform, 1000, {});
    world.updateAndCheck();
    world.advance();
    world.grid.begin();
    CollectCount found;
    world.grid.here().grid().visit(SphereRegion<float>({0, 0, 0}, 1e9F), found);
    EXPECT_EQ(world.grid.here().grid().size(), found.count());
    world.grid.end();
    EXPECT_EQ("", world.grid.here().validate());
}

TEST(DistributedGrid, GoesOnWithAPartition) {
    std::vector<Cut<float>> cuts;
    while (static_cast<int>(cuts.size()) + 1 < rankCount()) {
        cuts.push_back({static_cast<float>(cuts.size()), 0});
    }
    DistributedConfig config;
    config.rebalanceAbove = std::numeric_limits<double>::infinity();
    DistributedGrid<float> grid(MPI_COMM_WORLD, Partition<float>(cuts), config);
    grid.update();
    grid.update();
    EXPECT_EQ(Partition<float>(cuts), grid.here().partition());
    EXPECT_FALSE(grid.lastCost().wasRebalanced);
}

}  // namespace
}  // namespace hashphase::test
