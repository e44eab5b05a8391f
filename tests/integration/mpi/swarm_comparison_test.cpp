// SPDX-License-Identifier: Zlib

// What is said of ranks and one process, which may fail after the ranks have finished; on one rank.

#include <demos/swarm/swarm_report.hpp>
#include <demos/swarm/swarm_run.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <new>
#include <sstream>
#include <stdexcept>
#include <string>

namespace hashphase::demos {
namespace {

class SwarmComparison : public testing::Test {
protected:
    static constexpr std::uint32_t kFrames = 3;

    [[nodiscard]] std::string said(const SingleRun& alone, bool holds) const {
        std::ostringstream out;
        EXPECT_EQ(printComparison(result_, alone, out), holds);
        return out.str();
    }
    template <class Fault>
    [[nodiscard]] SingleRun failedBy(const Fault& fault) const {
        return tryAlone(scene_, kFrames, [&](std::uint32_t) { throw fault; });
    }

    SwarmScene scene_{SwarmKind::uniform, 1000, 1};
    SwarmResult result_ =
        runSwarm(MPI_COMM_WORLD, scene_, kFrames, {}, [](std::uint32_t, const auto&) {});
};

TEST_F(SwarmComparison, HoldsIfOneProcessHasTheSamePairs) {
    SingleRun alone = tryAlone(scene_, kFrames, [](std::uint32_t) {});
    EXPECT_EQ(said(alone, true).find("Births and deaths of every frame, and all "), 0);
    ++alone.result->last.count;
    EXPECT_EQ(said(alone, false).find("WRONG: After the last frame the ranks have "), 0);
}

TEST_F(SwarmComparison, IsLeftOutWithoutASecondRun) {
    EXPECT_EQ(said({}, true), "Not compared with one process.\n");
}

TEST_F(SwarmComparison, SaysWhyOneProcessHasFailed) {
    EXPECT_EQ(said(failedBy(std::bad_alloc()), false),
              "Not compared with one process: it has too little memory for all spheres.\n");
    EXPECT_EQ(said(failedBy(std::length_error("many")), false),
              "Not compared with one process: a grid cannot hold all spheres and pairs.\n");
}

}  // namespace
}  // namespace hashphase::demos
