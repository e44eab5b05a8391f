// SPDX-License-Identifier: Zlib
#include <demos/console/format.hpp>
#include <demos/console/nearest_name.hpp>
#include <demos/console/progress.hpp>
#include <demos/console/table.hpp>

#include <gtest/gtest.h>

#include <sstream>
#include <thread>

namespace hashphase::demos {
namespace {

const std::vector<std::string> kNames{"paper", "uniform", "piles", "pile", "static-city"};

TEST(NearestName, CountsInsertedRemovedReplacedAndSwappedLetters) {
    EXPECT_EQ(editDistance("paper", "paper"), 0U);
    EXPECT_EQ(editDistance("papr", "paper"), 1U);
    EXPECT_EQ(editDistance("papeer", "paper"), 1U);
    EXPECT_EQ(editDistance("piper", "paper"), 1U);
    EXPECT_EQ(editDistance("papre", "paper"), 1U);
    EXPECT_EQ(editDistance("", "paper"), 5U);
    EXPECT_EQ(editDistance("kitten", "sitting"), 3U);
}

TEST(NearestName, SuggestsTheNearestAndTheFirstOfSeveral) {
    EXPECT_EQ(nearestName("papre", kNames), "paper");
    EXPECT_EQ(nearestName("pil", kNames), "pile");
    EXPECT_EQ(nearestName("staticcity", kNames), "static-city");
    EXPECT_EQ(nearestName("statci_cty", kNames), "static-city");
}

TEST(NearestName, SuggestsNothingForWhatIsNoMisspelling) {
    EXPECT_EQ(nearestName("elephant", kNames), "");
    EXPECT_EQ(nearestName("xy", std::vector<std::string>{"ab"}), "");
}

TEST(NearestName, ListsAllNamesWhereNoneIsNear) {
    EXPECT_EQ(unknownNameSentence("scene", "papr", kNames),
              "There is no scene 'papr'; did you mean 'paper'?");
    EXPECT_EQ(unknownNameSentence("scene", "\x1b[2Jpapr", kNames).substr(0, 31),
              "There is no scene '?[2Jpapr'; t");
    EXPECT_EQ(unknownNameSentence("scene", "elephant", kNames),
              "There is no scene 'elephant'; there are paper, uniform, piles, pile, static-city.");
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

TEST(Table, AlignsColumnsAndLeavesNoBlanksAtLineEnds) {
    Table table({"name", "ms", "note"});
    table.addRow({"hash", "1.5", ""});
    table.addRow({"dbvt-deferred", "12.25", "x"});
    std::ostringstream out;
    table.print(out);
    EXPECT_EQ(out.str(),
              "name              ms  note\n"
              "--------------------------\n"
              "hash             1.5\n"
              "dbvt-deferred  12.25     x\n");
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
