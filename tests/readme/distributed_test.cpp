// SPDX-License-Identifier: Zlib

// The pieces of C++ of integration/guide/distributed.md, on one rank.

#include <integration/mpi/distributed_grid.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstring>
#include <span>
#include <vector>

namespace hashphase::test {
namespace {

/// MPI is begun for the tests that need it, and ended behind all of them.
class Mpi : public testing::Environment {
public:
    static void begin() {
        int isReady = 0;
        MPI_Initialized(&isReady);
        if (isReady == 0) {
            MPI_Init(nullptr, nullptr);
        }
    }
    void TearDown() override {
        int isReady = 0;
        MPI_Initialized(&isReady);
        if (isReady != 0) {
            MPI_Finalize();
        }
    }
};
[[maybe_unused]] const testing::Environment* const kMpi =
    testing::AddGlobalTestEnvironment(new Mpi);

struct Grain {
    std::uint64_t number = 0;
    float x = 0;
};

Aabb<float> boxOf(const Grain& grain) {
    return boxAround<float>({grain.x, 0, 0}, 0.6F);
}

TEST(Distributed, PageIsRight) {
    Mpi::begin();
    std::vector<Grain> grainsOfThisRank;
    for (std::uint64_t i = 0; i < 20; ++i) {
        grainsOfThisRank.push_back({i, static_cast<float>(i)});
    }
    std::size_t pairs = 0;
    const auto collide = [&](const ProxyPair&) { ++pairs; };
    const auto moved = [](ProxyId, const Aabb<float>& box) {
        return Aabb<float>(box.min().array() + 0.01F, box.max().array() + 0.01F);
    };
    const int frames = 3;
#include <distributed_1.inl>
    EXPECT_EQ(3 * 19U, pairs);
    const auto thinkOfOtherThings = [] {};
    {
#include <distributed_2.inl>
        EXPECT_TRUE(later.pairs.born.empty());
    }
    {
#include <distributed_3.inl>
        EXPECT_TRUE(here.isOwned(known));
    }
    {
#include <distributed_4.inl>
        EXPECT_EQ(19U, all.size());
        EXPECT_EQ(19U, sum.count);
    }
    std::vector<std::array<float, 3>> forces(here.grid().indexLimit());
    const auto addForce = [&](ProxyId, std::span<const std::byte>) { ADD_FAILURE(); };
    {
#include <distributed_5.inl>
        EXPECT_TRUE(forGhosts.empty());
    }
    {
#include <distributed_6.inl>
        EXPECT_EQ(1U, answers.of(1).size());
        EXPECT_EQ(2U, answers.of(2).size());
    }
    const double millisecondsOfThisRanksStep = 7;
#include <distributed_7.inl>
    grid.update();
}

TEST(Distributed, PartCarriedByOtherMeansIsRight) {
    const std::uint32_t rank = 0;
    const Partition<float> partition;
    const Aabb<float> box(Vector3<float>(0, 0, 0), Vector3<float>(1, 1, 1));
    const auto carry = [](std::uint32_t, std::span<const std::byte>) {};
    const std::vector<Parcel> receivedParcels;
#include <distributed_8.inl>
    EXPECT_TRUE(reported.pairs.born.empty());
    EXPECT_EQ(1U, part.size());
}

}  // namespace
}  // namespace hashphase::test
