// SPDX-License-Identifier: Zlib
#include <demos/console/format.hpp>
#include <demos/console/progress.hpp>

#include <gtest/gtest.h>

#include <map>
#include <sstream>
#include <thread>

namespace hashphase::demos {
namespace {

const std::vector<std::string> kNames{"paper", "uniform", "piles", "pile", "static-city"};

TEST(UnknownName, BringsTheNearestAndTheFirstOfSeveralToMind) {
    for (const auto& [name, meant] :
         std::map<std::string, std::string>{{"papr", "paper"},
                                            {"papeer", "paper"},
                                            {"piper", "paper"},
                                            {"papre", "paper"},
                                            {"pil", "pile"},
                                            {"pilex", "piles"},
                                            {"statci_cty", "static-city"}}) {
        EXPECT_EQ(unknownNameSentence("scene", name, kNames),
                  "There is no scene '" + name + "'; did you mean '" + meant + "'?");
    }
    EXPECT_EQ(suggestion("papre", std::vector<std::string>{"pap", "paper"}, ""),
              "; did you mean paper?")
        << "letters that are swapped are one mistake, and two that are missing are two";
}

TEST(UnknownName, ListsAllNamesWhereItIsNoMisspelling) {
    EXPECT_EQ(unknownNameSentence("scene", "elephant", kNames),
              "There is no scene 'elephant'; there are paper, uniform, piles, pile, static-city.");
    EXPECT_EQ(suggestion("xy", std::vector<std::string>{"ab"}, ""), "; there are ab.");
    EXPECT_EQ(unknownNameSentence("scene", "\x1b[2Jpapr", kNames).substr(0, 31),
              "There is no scene '?[2Jpapr'; t");
}

TEST(Format, GroupsThousands) {
    EXPECT_EQ(withThousands(0), "0");
    EXPECT_EQ(withThousands(999), "999");
    EXPECT_EQ(withThousands(1000), "1,000");
    EXPECT_EQ(withThousands(1234567), "1,234,567");
}

TEST(Format, KeepsThreeDigitsOfMilliseconds) {
    EXPECT_EQ(milliseconds(0.01234), "0.0123");
    EXPECT_EQ(milliseconds(0.1234), "0.123");
    EXPECT_EQ(milliseconds(1.234), "1.23");
    EXPECT_EQ(milliseconds(9.999), "10.0");
    EXPECT_EQ(milliseconds(123.4), "123");
}

TEST(Format, ChoosesAUnitForBytes) {
    EXPECT_EQ(byteSize(1023), "1023 B");
    EXPECT_EQ(byteSize(1536), "1.50 KiB");
    EXPECT_EQ(byteSize(12 * 1024 * 1024), "12.0 MiB");
    EXPECT_EQ(byteSize(-2048), "-2.00 KiB");
}

TEST(Progress, DrawsABarWithTheRemainingTimeAndWipesIt) {
    std::ostringstream out;
    {
        Progress progress(out, ProgressStyle::kBar, "frame", 4);
        std::this_thread::sleep_for(std::chrono::milliseconds(120));
        progress.update(2);
    }
    const std::string text = out.str();
    EXPECT_EQ(text.rfind("\r[..............................] frame\r", 0), 0U)
        << "from the beginning: " << text;
    EXPECT_NE(text.find("\r[###############...............] frame: 2 of 4, "), std::string::npos)
        << text;
    EXPECT_NE(text.find(" s to go"), std::string::npos);
    EXPECT_EQ(text.back(), '\r');
}

TEST(Progress, IsSilentWhenAskedToBe) {
    std::ostringstream out;
    {
        Progress progress(out, ProgressStyle::kSilent, "frame", 4);
        std::this_thread::sleep_for(std::chrono::milliseconds(120));
        progress.update(2);
    }
    EXPECT_EQ(out.str(), "");
}

}  // namespace
}  // namespace hashphase::demos
