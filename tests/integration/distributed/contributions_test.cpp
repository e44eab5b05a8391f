// SPDX-License-Identifier: Zlib
#include <integration/distributed/contributions.hpp>
#include <tests/integration/distributed/rank_world.hpp>
#include <tests/support/handlers.hpp>

#include <array>
#include <cstring>
#include <deque>

namespace hashphase::test {
namespace {

/// Each pair adds one to both of its objects, on the rank that reports it; homes get the sums.
std::map<GlobalId, std::uint32_t> countedByRanks(const RankWorld<float>& world) {
    const std::size_t count = world.ranks.size();
    std::vector<Contributions> contributions(count);
    std::vector<std::vector<Parcel>> received(count);
    std::map<GlobalId, std::uint32_t> sums;
    std::deque<std::uint32_t> numbers;
    for (const auto& rank : world.ranks) {
        std::map<ProxyId, std::uint32_t> here;
        rank->forEachPair([&](const ProxyPair& pair) {
            ++here[pair.first];
            ++here[pair.second];
        });
        std::vector<Contribution> forGhosts;
        for (const auto& [proxy, number] : here) {
            if (rank->isOwned(proxy)) {
                sums[rank->globalId(proxy)] += number;
            } else {
                numbers.push_back(number);
                forGhosts.push_back({proxy, std::as_bytes(std::span(&numbers.back(), 1)), 0});
            }
        }
        for (const Parcel& parcel : contributions[rank->rank()].pack(*rank, forGhosts)) {
            received[parcel.rank].push_back({rank->rank(), parcel.bytes});
        }
    }
    std::vector<Contributions> receiving(count);
    for (const auto& rank : world.ranks) {
        std::uint32_t last = 0;
        for (const Contribution& one :
             receiving[rank->rank()].finish(*rank, received[rank->rank()])) {
            std::uint32_t number = 0;
            EXPECT_EQ(sizeof(number), one.bytes.size());
            EXPECT_TRUE(rank->isOwned(one.proxy));
            EXPECT_LE(last, one.rank);
            last = one.rank;
            std::memcpy(&number, one.bytes.data(), sizeof(number));
            sums[rank->globalId(one.proxy)] += number;
        }
    }
    return sums;
}

TEST(Contributions, ReachTheHomesOfAllObjects) {
    for (const BoxScene<float>& scene : allBoxScenes<float>()) {
        SCOPED_TRACE(scene.name);
        Random random(11);
        RankWorld<float> world(Partition<float>(std::vector<Cut<float>>(6)));
        for (int i = 0; i < 200; ++i) {
            world.add(random.below(7), scene.draw(random));
        }
        world.update();
        world.setPartition(world.balanced());
        world.update();
        std::map<GlobalId, std::uint32_t> expected;
        std::vector<GlobalPair> pairs;
        for (const auto& rank : world.ranks) {
            rank->collect(pairs);
        }
        for (const GlobalPair& pair : pairs) {
            ++expected[pair.first];
            ++expected[pair.second];
        }
        EXPECT_EQ(expected, countedByRanks(world));
    }
}

TEST(Contributions, ThatAreNoneAreRefused) {
    RankWorld<float> world(Partition<float>(std::vector<Cut<float>>{{0, 0}}));
    const GlobalId object = world.add(0, makeBox<float>(-1, 0, 0, 1, 1, 1));
    world.update();
    const ProxyId ghost = world.ranks[1]->find(object);
    const std::array<std::byte, 3> three{};
    const Contribution one{ghost, three, 0};
    Contributions sending;
    const auto parcels = sending.pack(*world.ranks[1], std::span(&one, 1));
    ASSERT_EQ(1U, parcels.size());
    EXPECT_EQ(0U, parcels[0].rank);
    const std::vector<std::byte> bytes(parcels[0].bytes.begin(), parcels[0].bytes.end());
    Contributions receiving;
    const auto take = [&](std::span<const std::byte> part) {
        const Parcel parcel{1, part};
        return receiving.finish(*world.ranks[0], std::span(&parcel, 1)).size();
    };
    EXPECT_EQ(1U, take(bytes));
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        EXPECT_THROW(take(std::span(bytes).first(size)), RankError);
    }
    for (std::size_t at = 0; at < 24; ++at) {
        auto changed = bytes;
        changed[at] ^= std::byte{0x7f};
        EXPECT_THROW(take(changed), RankError) << at;
    }
}

#if HASHPHASE_ENABLE_ASSERTS

TEST(Contributions, ForObjectsThatLiveHereAreAsserted) {
    const ThrowingAsserts throwing;
    RankWorld<float> world{Partition<float>()};
    const GlobalId object = world.add(0, makeBox<float>(0, 0, 0, 1, 1, 1));
    world.update();
    const Contribution one{world.ranks[0]->find(object), {}, 0};
    Contributions sending;
    EXPECT_THROW(sending.pack(*world.ranks[0], std::span(&one, 1)), BrokenAssert);
}

#endif

}  // namespace
}  // namespace hashphase::test
