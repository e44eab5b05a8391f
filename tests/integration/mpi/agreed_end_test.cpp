// SPDX-License-Identifier: Zlib

// How an interruption of one rank ends the frames of all; on three ranks.

#include <demos/swarm/agreed_end.hpp>
#include <tests/integration/mpi/ranks_here.hpp>

#include <gtest/gtest.h>

#include <csignal>

namespace hashphase::demos {
namespace {

using test::rankHere;

TEST(AgreedEnd, IsCalledForOnAllRanksInTheFrameAfterOneIsInterrupted) {
    const NotedSignals signals;
    AgreedEnd end(MPI_COMM_WORLD, 60);
    EXPECT_FALSE(end.isCalledFor());
    if (rankHere() == 1) {
        std::raise(SIGTERM);
    }
    EXPECT_FALSE(end.isCalledFor());
    EXPECT_TRUE(end.isCalledFor());
    EXPECT_TRUE(end.take());
}

TEST(AgreedEnd, IsNotWaitedForLongerThanPatience) {
    AgreedEnd end(MPI_COMM_WORLD, 2);
    EXPECT_FALSE(end.isCalledFor());
    if (rankHere() != 1) {
        EXPECT_THROW(
            {
                static_cast<void>(end.isCalledFor());
                static_cast<void>(end.isCalledFor());
            },
            RankError);
    }
}

}  // namespace
}  // namespace hashphase::demos
