// SPDX-License-Identifier: Zlib
#include <demos/console/columns.hpp>
#include <demos/console/format.hpp>
#include <demos/console/progress.hpp>

#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <sstream>
#include <string>
#include <utility>

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

// --- Progress on a machine whose clock stands still until it is moved ----------------------------

std::chrono::steady_clock::time_point timeNow;
std::size_t terminalColumns = 80;

constexpr ProgressSurroundings kStill{[] { return terminalColumns; }, [] { return timeNow; }};

void passSeconds(int seconds) {
    timeNow += std::chrono::seconds(seconds);
}

/// What stands behind the last return of the carriage but the one that wipes it.
std::string lastLine(const std::ostringstream& out) {
    const std::string text = out.str();
    return text.substr(text.rfind('\r') + 1);
}

TEST(Progress, DrawsABarWithTheRemainingTimeAndWipesIt) {
    terminalColumns = 80;
    std::ostringstream out;
    {
        Progress progress(out, ProgressStyle::kBar, "frame", 4, kStill);
        progress.update(0);
        passSeconds(5);
        progress.update(2);
    }
    const std::string text = out.str();
    EXPECT_EQ(text.rfind("\r[..............................] frame\r", 0), 0U)
        << "from the beginning: " << text;
    EXPECT_NE(text.find("\r[###############...............] frame: 2 of 4, 5.0 s to go"),
              std::string::npos)
        << text;
    EXPECT_EQ(text.back(), '\r');
}

TEST(Progress, EstimatesFromTheFirstUpdateOnAndNotTooEarly) {
    EXPECT_EQ(secondsToGo(1.9, 0.5), std::nullopt);
    EXPECT_EQ(secondsToGo(100, 0.02), std::nullopt);
    EXPECT_EQ(secondsToGo(2, 0.5), 2.0);
    EXPECT_EQ(secondsToGo(60, 1), 0.0);
    std::ostringstream out;
    Progress progress(out, ProgressStyle::kBar, "frame", 100, kStill);
    passSeconds(1000);
    progress.update(0);
    passSeconds(1);
    progress.update(50);
    EXPECT_EQ(out.str().find("to go"), std::string::npos);
    passSeconds(3);
    progress.update(50);
    EXPECT_NE(lastLine(out).find("50 of 100, 4.0 s to go"), std::string::npos) << lastLine(out);
}

TEST(Progress, FitsTheTerminalAndKeepsTheTimeThatIsLeft) {
    std::ostringstream out;
    Progress progress(out, ProgressStyle::kBar, "opening \x1b[2J", 100, kStill);
    progress.update(0);
    for (const std::size_t columns : {60U, 80U, 200U, 20U}) {
        terminalColumns = columns;
        passSeconds(5);
        progress.update(50, "caf\xc3\xa9, " + std::string(200, 'x'));
        EXPECT_EQ(columnsOf(lastLine(out)), columns - 1);
        EXPECT_EQ(lastLine(out).find('\x1b'), std::string::npos);
        if (columns > 50) {
            EXPECT_NE(lastLine(out).find("..., "), std::string::npos) << lastLine(out);
            EXPECT_TRUE(lastLine(out).ends_with(" s to go")) << lastLine(out);
        }
    }
    terminalColumns = 0;  // one that reports none
    passSeconds(5);
    progress.update(50, std::string(200, 'x'));
    EXPECT_EQ(columnsOf(lastLine(out).substr(0, 79)), 79U);
}

TEST(Progress, IsSilentWhenAskedToBe) {
    std::ostringstream out;
    {
        Progress progress(out, ProgressStyle::kSilent, "frame", 4, kStill);
        progress.update(0);
        passSeconds(10);
        progress.update(2);
    }
    EXPECT_EQ(out.str(), "");
}

// --- Lines ---------------------------------------------------------------------------------------

TEST(Columns, CountCharacters) {
    EXPECT_EQ(columnsOf(""), 0U);
    EXPECT_EQ(columnsOf("caf\xc3\xa9"), 4U);
    EXPECT_EQ(clipped("caf\xc3\xa9s", 5), "caf\xc3\xa9s");
    EXPECT_EQ(clipped("caf\xc3\xa9 noir", 7), "caf\xc3\xa9...");
    EXPECT_EQ(clipped("coffee", 2), "..");
    EXPECT_EQ(clipped("coffee", 0), "");
}

TEST(Columns, WrapTextAtBlanks) {
    EXPECT_EQ(wrapped("one two three", 7), "one two\nthree");
    EXPECT_EQ(wrapped("one two three", 8, 4), "one two\n    three");
    EXPECT_EQ(wrapped("  holds   all of it", 12, 4), "  holds\n    all of\n    it");
    EXPECT_EQ(wrapped("unbreakable is it", 5), "unbreakable\nis it");
    EXPECT_EQ(wrapped("caf\xc3\xa9 caf\xc3\xa9", 9), "caf\xc3\xa9 caf\xc3\xa9");
    EXPECT_EQ(wrapped("one\n\ntwo ", 9), "one\n\ntwo") << "breaks of its own stay";
    EXPECT_EQ(wrapped("", 9), "");
}

TEST(Columns, AreThoseOfTheTerminalUpToAHundred) {
    std::ostringstream out;
    Console console{out, out, false, ""};
    for (const auto& [columns, width] : {std::pair{0U, 100U}, {70U, 70U}, {250U, 100U}}) {
        console.columns = columns;
        EXPECT_EQ(lineWidth(console), width);
    }
}

TEST(Masked, IsNothingThatATerminalWouldObey) {
    EXPECT_EQ(masked("caf\xc3\xa9 \xe2\x82\xac \xf0\x9f\x98\x80"),
              "caf\xc3\xa9 \xe2\x82\xac \xf0\x9f\x98\x80");
    EXPECT_EQ(masked("\x89PNG\r\n\x1b[2J\x7f"), "?PNG???[2J?");
    EXPECT_EQ(masked("\xc2\x9b"
                     "2J"),
              "?2J")
        << "as Latin-1 it begins what terminals obey";
    for (const char* bytes : {"\x80", "\xc1\x81", "\xe0\x80\x80", "\xed\xa0\x80",
                              "\xf4\x90\x80\x80", "\xff", "\xc3", "\xe2\x82"}) {
        EXPECT_EQ(characterLength(bytes), 0U) << "not UTF-8";
        EXPECT_EQ(masked(bytes).find_first_not_of('?'), std::string::npos);
    }
    EXPECT_EQ(quotedWord(std::string(39, 'x') + "\xc3\xa9"), "'" + std::string(39, 'x') + "...'")
        << "not within a character";
}

}  // namespace
}  // namespace hashphase::demos
