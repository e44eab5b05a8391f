// SPDX-License-Identifier: Zlib

// The hard cases of `hashphase stability`, with the grid alone, in both precisions.

#include <tests/support/hard_case_check.hpp>

namespace hashphase::test {
namespace {

class HardCases : public testing::TestWithParam<demos::HardCase> {};

TEST_P(HardCases, HoldInSinglePrecision) {
    expectHolds<float>(GetParam());
}
TEST_P(HardCases, HoldInDoublePrecision) {
    expectHolds<double>(GetParam());
}

INSTANTIATE_TEST_SUITE_P(Grid, HardCases, testing::ValuesIn(demos::gridCases()), nameOfCase);

}  // namespace
}  // namespace hashphase::test
