// SPDX-License-Identifier: Zlib

// What ends a grid over MPI: each test is run by itself, on three ranks, and must end with a clear sentence on all of
// them, in time.

#include <integration/mpi/distributed_grid.hpp>
#include <tests/integration/mpi/ranks_here.hpp>

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace hashphase::test {
namespace {

const Aabb<float> kBox(Vector3<float>(0, 0, 0), Vector3<float>(1, 1, 1));

/// What RankError says; empty where none is thrown.
template <class Work>
std::string complaint(const Work& work) {
    try {
        work();
    } catch (const RankError& error) {
        return error.what();
    }
    return "";
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

DistributedConfig patient(double seconds) {
    DistributedConfig config;
    config.patience = seconds;
    return config;
}

TEST(MpiFailure, RanksThatDisagreeOnTheConfigurationAllSaySo) {
    DistributedConfig config = patient(20);
    config.rankGrid.payloadBytes = rankHere() == 1 ? 16 : 8;
    const std::string text =
        complaint([&] { const DistributedGrid<float> grid(MPI_COMM_WORLD, config); });
    EXPECT_TRUE(contains(
        text, "The ranks disagree on RankGridConfig::payloadBytes: it is from 8 to 16, and here "))
        << text;
}

TEST(MpiFailure, RanksThatDisagreeOnThePartitionAllSaySo) {
    const float at = rankHere() == 2 ? 2.F : 3.F;
    const Partition<float> partition(std::vector<Cut<float>>{{at, 0}, {5, 1}});
    const std::string text = complaint(
        [&] { const DistributedGrid<float> grid(MPI_COMM_WORLD, partition, patient(20)); });
    EXPECT_TRUE(contains(text, "The ranks disagree on the partition")) << text;
}

TEST(MpiFailure, APartitionOfOtherRanksIsRefusedOnAll) {
    const std::string text = complaint(
        [] { const DistributedGrid<float> grid(MPI_COMM_WORLD, Partition<float>(), patient(20)); });
    EXPECT_EQ(
        "The partition has 1 ranks, but the communicator has 3. Make a partition for that number.",
        text);
}

TEST(MpiFailure, ABadConfigurationIsRefusedOnAllRanks) {
    DistributedConfig config = patient(20);
    config.rankGrid.grid.cellSize = -1;
    EXPECT_THROW(DistributedGrid<float>(MPI_COMM_WORLD, config), std::invalid_argument);
    config = patient(20);
    config.rebalanceAbove = 0.5;
    EXPECT_THROW(DistributedGrid<float>(MPI_COMM_WORLD, config), std::invalid_argument);
}

TEST(MpiFailure, ARankThatIsLeftByAnExceptionIsNamedOnTheOthers) {
    const auto run = [] {
        DistributedGrid<float> grid(MPI_COMM_WORLD, patient(60));
        for (int frame = 0;; ++frame) {
            if (frame == 3 && rankHere() == 2) {
                throw std::runtime_error("a fault of the program");
            }
            grid.update();
        }
    };
    if (rankHere() == 2) {
        EXPECT_THROW(run(), std::runtime_error);
    } else {
        EXPECT_EQ(
            "Rank 2 of 3 gave up. An exception of the program destroyed its grid. See the output "
            "of that rank.",
            complaint(run));
    }
}

TEST(MpiFailure, AnIdThatTwoRanksHaveGivenIsNamedOnAll) {
    DistributedGrid<float> grid(MPI_COMM_WORLD, patient(60));
    grid.add(GlobalId{rankHere() == 0 ? 1U : 2U}, kBox);  // by ranks 1 and 2
    const std::string text = complaint([&] {
        for (int frame = 0; frame < 3; ++frame) {
            grid.update();
        }
    });
    EXPECT_TRUE(contains(text, "The global id 2 names two objects")) << text;
    EXPECT_EQ(text, complaint([&] { grid.update(); }));  // of no more use
}

TEST(MpiFailure, AMessageThatLiesAboutItsLengthIsNamedOnAll) {
    DistributedGrid<float> grid(MPI_COMM_WORLD, patient(60));
    grid.update();
    std::vector<std::byte> garbage(100, std::byte{7});
    MPI_Request request = MPI_REQUEST_NULL;
    if (rankHere() == 1) {
        // As the second update sends its messages.
        MPI_Isend(garbage.data(), 100, MPI_BYTE, 0, detail::Ranks::kFirstTag, grid.communicator(),
                  &request);
    }
    MPI_Barrier(MPI_COMM_WORLD);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    const std::string text = complaint([&] {
        for (int frame = 0; frame < 5; ++frame) {
            grid.update();
        }
    });
    EXPECT_TRUE(contains(text, "Rank 0 of 3 gave up. The parcel from rank 1 ")) << text;
    if (request != MPI_REQUEST_NULL) {
        MPI_Wait(&request, MPI_STATUS_IGNORE);
    }
}

TEST(MpiFailure, ARankThatDoesNotAnswerIsNotWaitedForLongerThanPatience) {
    DistributedGrid<float> grid(MPI_COMM_WORLD, patient(5));
    grid.update();
    if (rankHere() == 1) {
        std::this_thread::sleep_for(std::chrono::seconds(12));
    }
    const auto begin = std::chrono::steady_clock::now();
    const std::string text = complaint([&] {
        grid.update();
        grid.update();
    });
    EXPECT_TRUE(contains(text, "is slow, or made other calls")) << text;
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(60));
}

TEST(MpiFailure, CallsInAnotherOrderAreNamedOnAll) {
    DistributedGrid<float> grid(MPI_COMM_WORLD, patient(60));
    grid.update();
    const std::string text = complaint([&] {
        if (rankHere() == 1) {
            grid.begin();
            grid.begin();
        }
        for (int frame = 0; frame < 3; ++frame) {
            grid.update();
        }
    });
    EXPECT_TRUE(contains(text, "Rank 1 of 3 gave up. It called begin()")) << text;
}

TEST(MpiFailure, QuestionsAfterAChangeAreNamedOnAll) {
    DistributedGrid<float> grid(MPI_COMM_WORLD, patient(60));
    grid.update();
    if (rankHere() == 2) {
        grid.add(GlobalId{1}, kBox);
    }
    const std::string text = complaint([&] {
        grid.pairSum();
        grid.update();
    });
    EXPECT_TRUE(contains(text, "Rank 2 of 3 gave up. It called ask() or pairSum() after")) << text;
}

TEST(MpiFailure, WorkBetweenBeginAndEndMayTakeLongerThanPatience) {
    DistributedGrid<float> grid(MPI_COMM_WORLD, patient(2));
    grid.update();
    for (int frame = 0; frame < 2; ++frame) {
        grid.begin();
        std::this_thread::sleep_for(std::chrono::seconds(3));  // all of them
        MPI_Barrier(MPI_COMM_WORLD);
        EXPECT_EQ("", complaint([&] { grid.end(); }));
    }
}

TEST(MpiFailure, AGridThatOutlivesMpiHarmsNobody) {
    static DistributedGrid<float> grid(MPI_COMM_WORLD, patient(60));
    grid.update();
}

// Of the tests that are not run as such: mpirun ends all ranks, with a sentence of its own.
TEST(MpiDeath, OfOneRank) {
    DistributedGrid<float> grid(MPI_COMM_WORLD, patient(60));
    for (int frame = 0;; ++frame) {
        if (frame == 3 && rankHere() == 1) {
            std::raise(SIGKILL);
        }
        grid.update();
    }
}

}  // namespace
}  // namespace hashphase::test
