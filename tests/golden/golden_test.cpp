// SPDX-License-Identifier: Zlib

// One result everywhere: the answers on record (golden.txt) are those of every compiler, level of
// optimisation, instruction set, number of threads, order of insertion, and treatment of denormals.
//
//     golden-tests                  compares
//     golden-tests --write FILE     records what this build answers; compare before you keep it
//
// tests/check golden builds it in many ways and compares them all.

#include <broadphase/diagnostics.hpp>
#include <broadphase/simd/kernels.hpp>
#include <demos/stability/flush_to_zero.hpp>
#include <tests/golden/golden_results.hpp>

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>

namespace hashphase::test {
namespace {

std::vector<GoldenLine> recordedLines() {
    std::ifstream file(HASHPHASE_GOLDEN_FILE);
    return {std::istream_iterator<GoldenLine>(file), {}};
}

/// The lines that differ, or that only one has; empty when there are none.
std::string differences(const std::vector<GoldenLine>& actual,
                        const std::vector<GoldenLine>& expected) {
    std::ostringstream text;
    std::size_t count = 0;
    for (std::size_t i = 0; i < std::max(actual.size(), expected.size()); ++i) {
        const GoldenLine here = i < actual.size() ? actual[i] : GoldenLine{};
        const GoldenLine there = i < expected.size() ? expected[i] : GoldenLine{};
        if (here != there && ++count <= 10) {
            text << "answered: " << here << "\nexpected: " << there << '\n';
        }
    }
    if (count > 10) {
        text << "and " << count - 10 << " more\n";
    }
    return text.str();
}

const std::vector<GoldenLine>& plainLines() {
    static const std::vector<GoldenLine> lines = goldenLines();
    return lines;
}

TEST(GoldenResults, AreThoseOnRecord) {
    const std::vector<GoldenLine> recorded = recordedLines();
    ASSERT_GT(recorded.size(), 300U);
    EXPECT_EQ(differences(plainLines(), recorded), "");
}

TEST(GoldenResults, AreTheSameWithEveryInstructionSet) {
    using detail::InstructionSet;
    const InstructionSet best = detail::instructionSet();
    for (const InstructionSet set : detail::kInstructionSets) {
        if (detail::isAvailable(set)) {
            detail::useInstructionSet(set);
            EXPECT_EQ(differences(goldenLines(), plainLines()), "") << detail::nameOf(set);
        }
    }
    detail::useInstructionSet(best);
}

TEST(GoldenResults, AreTheSameOnAnyNumberOfThreads) {
    for (const std::size_t threadCount : {2U, 3U, 16U}) {
        EXPECT_EQ(differences(goldenLines({.threadCount = threadCount}), plainLines()), "")
            << threadCount << " threads";
    }
}

TEST(GoldenResults, AreTheSameInWhateverOrderObjectsWereAdded) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        EXPECT_EQ(differences(goldenLines({.insertionSeed = seed}), plainLines()), "")
            << "order " << seed;
    }
}

TEST(GoldenResults, AreTheSameWhereDenormalsAreFlushed) {
    if (!demos::FlushToZero::isAvailable()) {
        GTEST_SKIP() << "it is not known how to set the mode of this processor";
    }
    const std::vector<GoldenLine> kept = goldenLines({.denormals = false});
    const demos::FlushToZero mode(true);
    EXPECT_EQ(differences(goldenLines({.denormals = false}), kept), "");
}

int write(const char* path) {
    std::ofstream file(path);
    for (const GoldenLine& line : goldenLines()) {
        file << line << '\n';
    }
    file.flush();
    if (!file) {
        std::fprintf(stderr, "golden-tests: %s cannot be written\n", path);
        return 1;
    }
    return 0;
}

}  // namespace
}  // namespace hashphase::test

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    hashphase::setMessageHandler([](const char*) {});  // bad numbers are part of the scenes
    if (argc == 3 && std::string_view(argv[1]) == "--write") {
        return hashphase::test::write(argv[2]);
    }
    if (argc > 1) {
        std::fprintf(stderr, "usage: golden-tests [--write FILE] [GoogleTest options]\n");
        return 2;
    }
    return RUN_ALL_TESTS();
}
