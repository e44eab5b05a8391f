// SPDX-License-Identifier: Zlib

// `hashphase try`, on programs that are compiled with Bullet's headers and know nothing of hashphase.

#include <demos/console/program.hpp>
#include <tests/demos/try/try_output.hpp>

#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <iterator>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

namespace hashphase::demos {
namespace {

const std::vector<std::string> kPrograms = [] {
    std::istringstream names(runScript("$stock").out);
    return std::vector<std::string>(std::istream_iterator<std::string>(names), {});
}();

TEST(StockPrograms, AreAllThere) {
    EXPECT_EQ(kPrograms.size(), 31U);
}

/// A program of a precision of Bullet's.
class TriedPrograms : public testing::TestWithParam<std::tuple<std::string, std::string>> {};

TEST_P(TriedPrograms, HasTheSameOutcomeWithEitherBroadphaseAndUnderVerification) {
    const auto& [file, name] = GetParam();
    if (!std::filesystem::exists(HASHPHASE_STOCK_FOLDER "/" + file)) {
        GTEST_SKIP() << file << " was not built";
    }
    const std::string call = "$folder/" + file + " " + name;
    const Output plain = runScript(call);
    ASSERT_EQ(plain.status, 0);
    ASSERT_FALSE(plain.out.empty());

    const Output verified = tryWords("--verify -- " + call);
    EXPECT_EQ(verified.status, kExitOk) << verified.out << verified.err;
    EXPECT_TRUE(verified.out.starts_with(plain.out))
        << "before: " << plain.out << "now: " << verified.out;
    ASSERT_TRUE(verified.json.is_object());
    const Json& pairs = verified.json["verification"];
    EXPECT_GT(pairs["calculations"], 0) << verified.out;
    EXPECT_EQ(pairs["missing"], 0) << verified.out;
    EXPECT_EQ(pairs["extra"], 0) << verified.out;
    EXPECT_EQ(pairs["bulletMissing"], 0) << verified.out;
    EXPECT_GE(pairs["bulletPairs"], pairs["bulletExtra"]);

    const Output compared = tryWords("-- " + call);
    EXPECT_EQ(compared.status, kExitOk) << compared.out << compared.err;
    EXPECT_TRUE(compared.out.starts_with(plain.out + plain.out))
        << "before: " << plain.out << compared.out;
    ASSERT_TRUE(compared.json.is_object());
    const Json& runs = compared.json["runs"];
    ASSERT_EQ(runs.size(), 2U);
    EXPECT_EQ(runs[0]["steps"].size(), runs[1]["steps"].size());
    EXPECT_EQ(runs[0]["dbvts"], runs[1]["dbvts"]);
    EXPECT_EQ(runs[0]["axisSweeps"], runs[1]["axisSweeps"]);
    for (const Json& step : runs[1]["steps"]) {
        if (!step["overlappingPairs"].is_null()) {
            EXPECT_EQ(step["overlappingPairs"], step["pairs"]);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(
    Stock, TriedPrograms,
    testing::Combine(testing::Values("stock-programs", "stock-programs-float64"),
                     testing::ValuesIn(kPrograms)),
    [](const auto& each) {
        std::string name = has(std::get<0>(each.param), "64") ? "double_" : "single_";
        for (const char letter : std::get<1>(each.param)) {
            name += std::isalnum(static_cast<unsigned char>(letter)) != 0 ? letter : '_';
        }
        return name;
    });

}  // namespace
}  // namespace hashphase::demos
