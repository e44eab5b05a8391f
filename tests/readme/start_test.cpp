// SPDX-License-Identifier: Zlib

// The piece of C++ of integration/guide/start.md.

#include <tests/readme/surroundings.hpp>

namespace hashphase::test {
namespace first {
#include <start_1.inl>
}  // namespace first

namespace {

TEST(StartPage, FirstProgramPrintsPairsAndAHit) {
    testing::internal::CaptureStdout();
    EXPECT_EQ(first::main(), 0);
    int pairs = 0;
    double height = 0;
    const std::string printed = testing::internal::GetCapturedStdout();
    ASSERT_EQ(std::sscanf(printed.c_str(), "pairs: %d the ray hits a ball at a height of %lf m",
                          &pairs, &height),
              2)
        << printed;
    EXPECT_GE(pairs, 100);  // of each ball with the ground
    EXPECT_EQ(height, 1);
}

}  // namespace
}  // namespace hashphase::test
