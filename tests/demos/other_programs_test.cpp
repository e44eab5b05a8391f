// SPDX-License-Identifier: Zlib
#include <demos/system/other_programs.hpp>

#include <gtest/gtest.h>

#include <cstddef>
#include <ctime>
#include <sstream>
#include <vector>

#include <sys/wait.h>
#include <unistd.h>

namespace hashphase::demos {
namespace {

std::optional<double> coresOf(const std::vector<std::optional<ProcessorTimes>>& readings) {
    std::size_t next = 0;
    const OtherPrograms others([&] { return readings.at(next++); });
    return others.cores();
}

TEST(OtherPrograms, UseWhatTheProcessorWorkedWithoutThisProgramAndItsChildren) {
    EXPECT_EQ(coresOf({{{100, 5000, 7}}, {{110, 5018, 17}}}), 0.8);
    EXPECT_EQ(coresOf({{{100, 5000, 7}}, {{110, 5010, 17}}}), 0) << "however busy they were before";
    EXPECT_EQ(coresOf({{{100, 5000, 7}}, {{110, 5009.9, 17}}}), 0) << "a tick too few";
}

TEST(OtherPrograms, AreUnknownWhereTheSystemDoesNotTellOrTheRunIsTooShort) {
    EXPECT_EQ(coresOf({std::nullopt, {{110, 5018, 17}}}), std::nullopt);
    EXPECT_EQ(coresOf({{{100, 5000, 7}}, std::nullopt}), std::nullopt);
    EXPECT_EQ(coresOf({{{100, 5000, 7}}, {{100.25, 5001, 7}}}), std::nullopt);
}

TEST(OtherPrograms, AreNotBusyWhileTheProcessorIdlesOrWaitsForDevices) {
    std::istringstream stat("cpu  1 20 300 4000 50000 600000 7000000 80000000 9 9\ncpu0 1 1 1 1\n");
    EXPECT_EQ(busyTicks(stat), 87'600'321);
    for (const char* other : {"", "cpu 1 2 3", "intr 1 2 3 4 5 6 7 8"}) {
        std::istringstream unknown(other);
        EXPECT_EQ(busyTicks(unknown), std::nullopt) << other;
    }
}

TEST(OtherPrograms, AreNotThisProgramNorItsChildren) {
    const std::optional<ProcessorTimes> begin = processorTimes();
    if (!begin) {
        GTEST_SKIP() << "no /proc/stat";
    }
    const auto work = [] {
        constexpr std::clock_t kTime = CLOCKS_PER_SEC / 20;
        const std::clock_t first = std::clock();
        while (std::clock() - first < kTime) {
        }
    };
    work();
    const double alone = processorTimes()->own;
    EXPECT_GE(alone - begin->own, 0.049);
    const pid_t child = fork();
    if (child == 0) {
        work();
        _exit(0);
    }
    ASSERT_EQ(waitpid(child, nullptr, 0), child);
    EXPECT_GE(processorTimes()->own - alone, 0.049);
}

}  // namespace
}  // namespace hashphase::demos
