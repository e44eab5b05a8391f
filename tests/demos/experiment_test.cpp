// SPDX-License-Identifier: Zlib

// What experiments are declared with: rows in SQLite, and SQL that says what is shown of them.

#include <demos/accuracy/binomial.hpp>
#include <demos/experiment/findings.hpp>
#include <demos/report/json_values.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace hashphase::demos {
namespace {

Value only(Measurements& measured, const std::string& expression) {
    return measured.ask("SELECT " + expression).rows.at(0).at(0);
}

Measurements threeFrames() {
    Measurements measured;
    for (int frame = 0; frame < 3; ++frame) {
        measured.add("frames", {{"method", frame == 2 ? "slow" : "quick"},
                                {"frame", frame},
                                {"ms", std::pow(10.0, frame)},
                                {"cells", frame == 0 ? Datum() : Datum(frame)}});
    }
    return measured;
}

std::string faultOf(std::string_view declaration) {
    Measurements measured = threeFrames();
    try {
        static_cast<void>(findingsOf(declaration, measured));
    } catch (const std::logic_error& fault) {
        return fault.what();
    }
    return "none";
}

TEST(Measurements, GiveBackWhatWasMeasured) {
    Measurements measured;
    const double tenth = 0.1;
    measured.add("all", {{"whole", std::uint64_t{1} << 40},
                         {"real", tenth},
                         {"text", "it's \"x\""},
                         {"truth", true},
                         {"nothing", std::optional<int>()},
                         {"not a number", std::numeric_limits<double>::quiet_NaN()},
                         {"endless", std::numeric_limits<double>::infinity()}});
    const DataTable all = measured.ask("SELECT * FROM \"all\"");
    ASSERT_EQ(all.rows.size(), 1U);
    EXPECT_EQ(all.columns[1].name, "real");
    const std::vector<Value> expected{std::pow(2.0, 40), tenth,   "it's \"x\"", 1.0,
                                      Value(),           Value(), INFINITY};
    EXPECT_EQ(all.rows[0], expected);
    EXPECT_EQ(only(measured, "whole || '' FROM \"all\""), Value("1099511627776"));
}

TEST(Measurements, KeepAllDigitsOfWholeNumbers) {
    Measurements measured;
    const std::int64_t most = std::int64_t{1} << 53;
    measured.add("all", {{"exact", most},
                         {"more", most + 1},
                         {"less", -most - 1},
                         {"largest", std::numeric_limits<std::uint64_t>::max()}});
    EXPECT_EQ(only(measured, "exact || ' ' || more || ' ' || less || ' ' || largest FROM \"all\""),
              Value("9007199254740992 9007199254740993 -9007199254740993 18446744073709551615"));
    EXPECT_EQ(only(measured, "exact FROM \"all\""), Value(static_cast<double>(most)));
}

TEST(Measurements, HaveEmptyTablesToo) {
    Measurements measured;
    measured.create("faults", {"frame", "what"});
    EXPECT_EQ(only(measured, "count(*) FROM faults"), Value(0.0));
    measured.add("faults", {{"frame", 3}, {"what", "lost"}});
    EXPECT_EQ(only(measured, "what FROM faults"), Value("lost"));
}

TEST(Measurements, RefuseRowsOfOtherColumns) {
    Measurements measured = threeFrames();
    EXPECT_THROW(measured.add("frames", {{"method", "x"}, {"frame", 1}}), std::logic_error);
    EXPECT_THROW(measured.add("frames", {{"frame", 1}, {"method", "x"}, {"ms", 1}, {"cells", 1}}),
                 std::logic_error);
}

TEST(Measurements, SayWhatIsWrongWithAStatement) {
    Measurements measured = threeFrames();
    try {
        static_cast<void>(measured.ask("SELECT speed FROM frames"));
        ADD_FAILURE();
    } catch (const std::logic_error& fault) {
        EXPECT_STREQ(fault.what(), "no such column: speed in: SELECT speed FROM frames");
    }
}

TEST(Measurements, TakeParametersByName) {
    Measurements measured = threeFrames();
    EXPECT_EQ(measured
                  .ask("SELECT frame FROM frames WHERE method = :method AND ms > :least",
                       {{"method", "quick"}, {"least", 5}, {"other", 1}})
                  .rows,
              (std::vector<std::vector<Value>>{{1.0}}));
}

struct Computed {
    const char* expression;
    Value value;
};

class MeasurementsFunction : public testing::TestWithParam<Computed> {};

TEST_P(MeasurementsFunction, Computes) {
    Measurements measured = threeFrames();
    EXPECT_EQ(only(measured, GetParam().expression), GetParam().value) << GetParam().expression;
}

INSTANTIATE_TEST_SUITE_P(
    All, MeasurementsFunction,
    testing::Values(Computed{"percent(1, 4)", 25.0}, Computed{"percent(0, 0)", 0.0},
                    Computed{"sqrt(9)", 3.0}, Computed{"sqrt(NULL)", Value()},
                    Computed{"interval_low(3, 10)", wilsonInterval(3, 10).low},
                    Computed{"interval_high(3, 10)", wilsonInterval(3, 10).high},
                    Computed{"interval_low(0, 0)", Value()},
                    Computed{"interval_high(30, 100, 10)", intervalOverFrames(30, 100, 10).high},
                    Computed{"thousands(12345)", "12,345"}, Computed{"thousands(NULL)", Value()},
                    Computed{"number(0.123456)", "0.1235"}, Computed{"number(NULL)", "-"},
                    Computed{"fixed(2, 1)", "2.0"}, Computed{"fixed(NULL, 1)", Value()},
                    Computed{"ms(0.01234)", "0.0123"}, Computed{"ms(NULL)", Value()},
                    Computed{"bytes(1536)", "1.50 KiB"}, Computed{"bytes(NULL)", Value()},
                    Computed{"median(ms) FROM frames", 10.0},
                    Computed{"percentile(ms, 0.25) FROM frames", 5.5},
                    Computed{"median(cells) FROM frames", 1.5},
                    Computed{"median(ms) FROM frames WHERE frame > 5", Value()}));

TEST(Findings, ShowEachStatementAsItsHeadingSays) {
    Measurements measured = threeFrames();
    const Findings findings = findingsOf(R"sql(
-- A comment; another one.
CREATE VIEW texts AS SELECT count(*) AS n, ' ms' AS unit FROM frames;
/* {"settings": "how"} */
SELECT 'Of ' || n || ' frames.' FROM texts;
/* {"conclusions": "what"} */
SELECT iif(method = 'slow', method || ' is slow.', NULL) FROM frames;
/* {"checks": "all"} */
SELECT 'Frames are there', count(*) > 0, count(*) || ' of 3' FROM frames
UNION ALL SELECT 'None is', count(*) = 0, 'so many' FROM frames;
/* {"choices": "all"} */
SELECT 'A task', method, ms, frame, 'in words', method = 'quick', ms - 1 FROM frames WHERE frame > 0;
/* {"table": "times"} */
SELECT method, ms AS "time: time of {n} [{unit}]" FROM frames;
/* {"rows": "quick ones"} */
SELECT frame FROM frames WHERE method = 'quick'
)sql",
                                         measured);
    EXPECT_EQ(findings.settings, std::vector<std::string>{"Of 3 frames."});
    EXPECT_EQ(findings.conclusions, std::vector<std::string>{"slow is slow."});
    ASSERT_EQ(findings.checks.size(), 2U);
    EXPECT_TRUE(findings.checks[0].holds);
    EXPECT_EQ(findings.checks[0].evidence, "3 of 3");
    EXPECT_FALSE(findings.checks[1].holds);
    ASSERT_EQ(findings.choices.size(), 2U);
    EXPECT_EQ(findings.choices[1].milliseconds, 100);
    EXPECT_EQ(findings.choices[1].low, 99);
    EXPECT_TRUE(findings.choices[0].isOurs && !findings.choices[1].isOurs);
    EXPECT_EQ(findings.tables.at(0).columns[1].name, "time");
    EXPECT_EQ(findings.tables[0].columns[1].title, "time of 3 [ ms]");
    EXPECT_EQ(findings.tables[0].rows.size(), 3U);
    EXPECT_EQ(findings.rows.at("quick ones").rows.size(), 2U);
}

TEST(Findings, DrawAChartForEachRowOfAQuestion) {
    Measurements measured = threeFrames();
    const Findings findings = findingsOf(R"sql(
CREATE VIEW texts AS SELECT 'three' AS n;
/* {"each": "SELECT DISTINCT method FROM frames", "chart": "T-{:method}", "title": "Of {:method} ones",
    "settings": "{n} frames", "mark": "point", "x": "frame names", "y": "ms log0", "series": "method",
    "front": true} */
SELECT method, frame, ms AS "ms: time [ms]" FROM frames WHERE method = :method;
/* {"each": "SELECT 1 AS one FROM frames WHERE ms > 5000", "table": "none"} */
SELECT ';' AS text;
/* {"table": "the last"} */
SELECT 1 AS one;
)sql",
                                         measured);
    ASSERT_EQ(findings.charts.size(), 2U);
    const Chart& chart = findings.charts[0];
    EXPECT_EQ(chart.name, "T-quick");
    EXPECT_EQ(chart.title, "Of quick ones");
    EXPECT_EQ(chart.settings, "three frames");
    EXPECT_EQ(chart.drawn, (std::map<std::string, std::string>{{"mark", "point"},
                                                               {"x", "frame names"},
                                                               {"y", "ms log0"},
                                                               {"series", "method"},
                                                               {"front", "true"}}));
    EXPECT_EQ(chart.data.rows.size(), 2U);
    EXPECT_EQ(findings.tables.size(), 1U);
}

TEST(Findings, ShowStatementsOfTheSameQuestionTogetherRowByRow) {
    Measurements measured = threeFrames();
    const Findings findings = findingsOf(R"sql(
CREATE VIEW texts AS SELECT 3 AS n;
/* {"conclusions": "first", "each": "SELECT frame FROM frames"} */
SELECT 'a' || :frame;
/* {"conclusions": "second", "each": "SELECT frame FROM frames", "when": "{:frame < 2}"} */
SELECT 'b' || :frame;
/* {"conclusions": "last"} */
SELECT 'c';
)sql",
                                         measured);
    EXPECT_EQ(findings.conclusions, (std::vector<std::string>{"a0", "b0", "a1", "b1", "a2", "c"}));
}

TEST(Findings, SpreadCellsOverColumns) {
    Measurements measured;
    const Findings findings = findingsOf(R"sql(
/* {"rows": "times", "spread": true} */
VALUES ('a', 1, 'x', 5), ('a', 1, 'y', NULL), ('a', 2, 'x', 6), ('a', 2, 'y', 'seven');
/* {"rows": "none", "spread": true} */
SELECT 1 AS one, 2 AS name, 3 AS number WHERE 0;
)sql",
                                         measured);
    const DataTable& times = findings.rows.at("times");
    ASSERT_EQ(times.columns.size(), 4U);
    EXPECT_EQ(times.columns[3].name, "y");
    EXPECT_EQ(times.rows, (std::vector<std::vector<Value>>{{"a", 1.0, 5.0, Value()},
                                                           {"a", 2.0, 6.0, "seven"}}));
    EXPECT_EQ(findings.rows.at("none").columns.size(), 1U);
}

TEST(Findings, NameTheFaultOfADeclaration) {
    EXPECT_EQ(
        faultOf("/* {\"chart\": \"C\", \"x\": \"when\", \"y\": \"ms\"} */ SELECT ms FROM frames;"),
        "There is no column 'when'.");
    EXPECT_EQ(faultOf("/* {\"chart\": \"C\", \"mark\": \"bars\"} */ SELECT ms FROM frames;"),
              "Nothing is drawn as 'bars'.");
    EXPECT_EQ(faultOf("/* {\"chart\": \"C\", \"y\": \"ms log1\"} */ SELECT ms FROM frames;"),
              "Nothing is drawn as 'log1'.");
    EXPECT_EQ(faultOf("/* {\"chart\": \"C\", \"x\": \"ms\"} */ SELECT ms FROM frames;"),
              "The chart 'C' has no y.");
    EXPECT_EQ(faultOf("/* {\"chart\": \"C\", \"mark\": \"cell\", \"x\": \"ms\", \"y\": \"ms\"} */ "
                      "SELECT ms FROM frames;"),
              "The chart 'C' has no shade.");
    EXPECT_EQ(faultOf("/* {\"chart\": \"C\", \"mark\": \"bar\", \"x\": \"ms names\", \"y\": \"ms "
                      "log0\"} */ SELECT ms FROM frames;"),
              "The bars of 'C' cannot begin at 0 on a logarithmic axis: draw points.");
    EXPECT_EQ(faultOf("/* {\"shown\": \"C\"} */ SELECT ms FROM frames;"),
              "Nothing is shown as {\"shown\":\"C\"}.");
    EXPECT_EQ(faultOf("SELEC 1;"), "near \"SELEC\": syntax error in: SELEC 1;");
}

TEST(RowsJson, MakesMembersOfColumns) {
    Measurements measured;
    const Json rows = rowsJson(measured.ask(
        "SELECT 'a' AS name, 1 AS \"yes?\", 0.5 AS \"time.median\", NULL AS \"time.low\", NULL AS "
        "\"gone.median\", '[1, 2]' AS \"pair{}\", 3.0 AS whole"));
    EXPECT_EQ(rows.dump(),
              "[{\"name\":\"a\",\"yes\":true,\"time\":{\"median\":0.5},\"gone\":null,"
              "\"pair\":[1,2],\"whole\":3}]");
}

TEST(Findings, HaveSectionsOfAPageWithGradedTablesAndAVerdict) {
    Measurements measured = threeFrames();
    const Findings findings = findingsOf(R"sql(
CREATE VIEW texts AS SELECT 'a' AS unit;
/* {"sentences": "of each", "section": "of {:method}", "each": "SELECT DISTINCT method FROM frames"} */
SELECT 'The ' || :method || ' one.';
/* {"sentences": "none", "section": "nothing"} */
SELECT NULL;
/* {"table": "goes with its section", "section": "nothing"} */
SELECT 1;
/* {"graded": "{unit} caption", "legend": ["g", "f", "p"], "section": "of slow"} */
VALUES ('1', 'x', 'c', '60+', 'good'), ('1', 'x', 'd', '<1', 'poor'), ('2', 'x', 'c', NULL, NULL),
       ('2', 'x', 'd', '30', 'fair');
/* {"conclusions": "of one", "section": "of quick"} */
SELECT count(*) || ' frames' FROM frames WHERE method = 'quick';
/* {"print": "{unit} table"} */
SELECT 7 AS seven;
/* {"verdict": "nothing compared"} */
SELECT 'Fine', NULL;
)sql",
                                         measured);
    ASSERT_EQ(findings.sections.size(), 2U);
    EXPECT_EQ(findings.sections[0].heading, "of quick");
    EXPECT_EQ(findings.sections[0].sentences, std::vector<std::string>{"The quick one."});
    EXPECT_EQ(findings.sections[0].conclusions, std::vector<std::string>{"2 frames"});
    const GradedTable& graded = findings.sections[1].graded.at(0);
    EXPECT_EQ(graded.caption, "a caption");
    EXPECT_EQ(graded.header, (std::vector<std::string>{"column1", "column2", "c", "d"}));
    ASSERT_EQ(graded.rows.size(), 2U);
    EXPECT_EQ(graded.rows[0][3].marked(), "<1!");
    EXPECT_EQ(graded.rows[1][2].marked(), "-");
    EXPECT_EQ(graded.rows[1][3].marked(), "30~");
    EXPECT_EQ(findings.printed.at(0).first, "a table");
    EXPECT_EQ(findings.verdict, "Fine");
    EXPECT_EQ(findings.holds, std::nullopt);
}

}  // namespace
}  // namespace hashphase::demos
