// SPDX-License-Identifier: Zlib
#include <demos/accuracy/accuracy_report.hpp>

#include <gtest/gtest.h>

namespace hashphase::demos {
namespace {

Choice choice(const std::string& task, const std::string& method, double milliseconds,
              double error) {
    return {task, method, milliseconds, error, "error of " + method, true};
}

/// The methods that the table advises.
std::string frontOf(const std::vector<Choice>& choices) {
    const DataTable table = adviceTable(choices);
    std::string methods;
    for (const std::vector<Value>& row : table.rows) {
        methods += "; " + valueText(row[table.columnOf("method")]);
    }
    return methods;
}

TEST(Advice, LeavesOutWhatIsSlowerAndWorse) {
    EXPECT_EQ(frontOf({choice("t", "exact", 4, 0), choice("t", "slow and bad", 5, 0.1),
                       choice("t", "fast", 1, 0.5), choice("t", "as fast, worse", 1, 0.6),
                       choice("t", "slower, as bad", 2, 0.5), choice("t", "between", 3, 0.2)}),
              "; fast; between; exact");
    EXPECT_EQ(frontOf({choice("t", "one", 1, 0), choice("t", "other", 1, 0)}), "; one")
        << "the first of equals stays";
    EXPECT_EQ(frontOf({}), "");
}

TEST(Advice, LetsOnlyChoicesOfOneTaskCompete) {
    EXPECT_EQ(
        frontOf({choice("b", "slow", 9, 1), choice("a", "fast", 1, 0), choice("b", "quick", 8, 1)}),
        "; quick; fast");
}

TEST(Advice, IsARowForEachChoiceThatIsLeft) {
    const DataTable table =
        adviceTable(std::vector{choice("t", "fast", 1, 0.5), choice("t", "exact", 2, 0)});
    ASSERT_EQ(table.rows.size(), 2U);
    EXPECT_EQ(table.rows[1][table.columnOf("method")], Value("exact"));
    EXPECT_EQ(table.rows[1][table.columnOf("milliseconds")], Value(2.0));
    EXPECT_EQ(table.rows[1][table.columnOf("result")], Value("error of exact"));
}

}  // namespace
}  // namespace hashphase::demos
