// SPDX-License-Identifier: Zlib
#include <demos/report/data_table.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <sstream>
#include <stdexcept>

namespace hashphase::demos {
namespace {

std::string csvOf(const DataTable& table) {
    std::ostringstream out;
    writeCsv(table, out);
    return out.str();
}

TEST(DataTable, WritesNumbersWithAllTheirDigits) {
    EXPECT_EQ(csvOf({{{"a"}, {"b"}, {"c"}}, {{0.1, 1e-300, 30000.0}, {1.0 / 3, -0.5, 1e21}}}),
              "a,b,c\n0.1,1e-300,30000\n0.3333333333333333,-0.5,1e+21\n");
}

TEST(DataTable, QuotesWhatWouldEndAField) {
    EXPECT_EQ(csvOf({{{"method"}, {"say \"how\""}}, {{"a, b", "plain"}, {"two\nlines", "\"x\""}}}),
              "method,\"say \"\"how\"\"\"\n\"a, b\",plain\n\"two\nlines\",\"\"\"x\"\"\"\n");
}

TEST(DataTable, LeavesWhatWasNotMeasuredEmpty) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(csvOf({{{"a"}, {"b"}, {"c"}, {"d"}}, {{Value(), nan, -infinity, ""}}}),
              "a,b,c,d\n,,,\n");
    EXPECT_EQ(valueText(Value()), "-");
    EXPECT_EQ(valueText(nan), "-");
    EXPECT_EQ(valueText(infinity), "-");
}

TEST(DataTable, ShowsFourDigitsAndThousands) {
    EXPECT_EQ(valueText(0.123456), "0.1235");
    EXPECT_EQ(valueText(12.0), "12");
    EXPECT_EQ(valueText(1234567.0), "1,234,567");
    EXPECT_EQ(valueText(-1234.4), "-1,234");
    EXPECT_EQ(valueText(0.0), "0");
    EXPECT_EQ(valueText("as it is"), "as it is");
}

TEST(DataTable, ShowsThreeDigitsOfTimesAndOfTheirRatios) {
    for (const char* title : {"frame [ms]", "median [ms a frame]", "time [ns/object]",
                              "a query [us]", "a ray [times Bullet's]", "times as fast as dbvt"}) {
        EXPECT_EQ(cellText(12.3456, {"t", title}), "12.3") << title;
    }
    for (const char* title :
         {"missed [share of the true pairs]", "memory [KiB]", "frames", "cell [m]"}) {
        EXPECT_EQ(cellText(12.3456, {"n", title}), "12.35") << title;
    }
    const DataColumn time{"ms", "frame [ms]"};
    EXPECT_EQ(cellText(0.00012, time), "0.000120");
    EXPECT_EQ(cellText(0.1, time), "0.100");
    EXPECT_EQ(cellText(9.996, time), "10.0");
    EXPECT_EQ(cellText(999.6, time), "1,000");
    EXPECT_EQ(cellText(123'456.0, time), "123,000");
    EXPECT_EQ(cellText(-1999.6, time), "-2,000");
    EXPECT_EQ(cellText(0.0, time), "0");
    EXPECT_EQ(cellText(Value(), time), "-");
    EXPECT_EQ(cellText("1/60 s", time), "1/60 s");
    std::ostringstream out;
    printTable({{{"name"}, time}, {{"hash", 1.23456}}}, out);
    EXPECT_NE(out.str().find("1.23\n"), std::string::npos) << out.str();
}

TEST(DataTable, IsAlignedInTextAndLeavesNoBlanksAtLineEnds) {
    const DataTable table{{{"name"}, {"ms"}, {"note"}},
                          {{"hash", "1.5", ""}, {"dbvt-deferred", 12.25, "x"}}};
    std::ostringstream out;
    printTable(table, out);
    EXPECT_EQ(out.str(),
              "name              ms  note\n"
              "--------------------------\n"
              "hash             1.5\n"
              "dbvt-deferred  12.25     x\n");
}

TEST(DataTable, BreaksLongCellsWhereItWouldBeTooWide) {
    const DataTable table{{{"name"}, {"what it does"}, {"n"}},
                          {{"a", "one two three four", 1.0}, {"b", "five", 22.0}, {"", "", ""}}};
    std::ostringstream out;
    printTable(table, out, {.columns = 20});
    EXPECT_EQ(out.str(),
              "name     what it   n\n"
              "            does\n"
              "--------------------\n"
              "a        one two   1\n"
              "      three four\n"
              "b           five  22\n"
              "\n");
    std::ostringstream words;
    printTable(table, words, {.columns = 3, .isOfWords = true});
    EXPECT_EQ(words.str(),
              "name  what   n\n"
              "      it\n"
              "      does\n"
              "---------------\n"
              "a     one    1\n"
              "      two\n"
              "      three\n"
              "      four\n"
              "b     five   22\n"
              "\n")
        << "words are not broken";
}

TEST(DataTable, FindsColumnsByName) {
    const DataTable table{{{"a"}, {"b", "the b"}}, {}};
    EXPECT_EQ(table.columnOf("b"), 1U);
    EXPECT_THROW(static_cast<void>(table.columnOf("the b")), std::logic_error);
    EXPECT_EQ(titleOf(table.columns[0]), "a");
    EXPECT_EQ(titleOf(table.columns[1]), "the b");
}

}  // namespace
}  // namespace hashphase::demos
