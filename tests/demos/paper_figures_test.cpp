// SPDX-License-Identifier: Zlib
#include <demos/paper/paper.hpp>
#include <tests/demos/asked.hpp>

#include <gtest/gtest.h>

#include <array>
#include <sstream>

namespace hashphase::demos {
namespace {

/// Every cell of a row measured, with the same time for a method in all of them [ms].
struct FigureRow {
    Phase phase;
    std::uint32_t objects;
    double unoptimized;
    double paperGrid;
    double hashphase;
    const char* part = "figure";
    double side = 400;
};

const std::vector<FigureRow> kFigureRows{
    {Phase::collision, 20'000, 900, 60, 10},   {Phase::collision, 50'000, 5'000, 50, 49},
    {Phase::visibility, 5'000, 0.2, 0.1, 0.3}, {Phase::visibility, 50'000, 2, 1, 2},
    {Phase::ai, 10'000, 40, 20, 60},           {Phase::ai, 50'000, 99, 98, 8}};

void addRun(const FigureRow& row, MethodKind kind, std::optional<double> cell, double milliseconds,
            Measurements& rows) {
    const std::int64_t run = rows.add("runs", {{"part", row.part},
                                               {"phase", nameOf(row.phase)},
                                               {"objects", row.objects},
                                               {"radius", 10},
                                               {"method", nameOf(kind)},
                                               {"cell", cell},
                                               {"side", row.side},
                                               {"triangles", 8 * row.side}});
    if (milliseconds > 0) {
        rows.add("frames", {{"run", run}, {"hash_ms", 0}, {"stand_ms", 0}, {"ms", milliseconds}});
        rows.add("memory", {{"run", run}, {"bytes", 1 << 20}, {"chosen_cell", 2.5}});
    }
    rows.add("checks",
             {{"run", run}, {"timed", 1}, {"objects", 1}, {"found", 1}, {"fault", Datum()}});
}

PaperReport reportOfRows(const std::vector<FigureRow>& figureRows) {
    Measurements rows;
    addPlan({}, rows);
    for (const FigureRow& row : figureRows) {
        addRun(row, MethodKind::unoptimized, std::nullopt, row.unoptimized, rows);
        addRun(row, MethodKind::hashphase, std::nullopt, row.hashphase, rows);
        for (const double cell : kPrintedCellSizes) {
            addRun(row, MethodKind::paperGrid, cell, row.paperGrid, rows);
            addRun(row, MethodKind::hashphase, cell, row.hashphase, rows);
        }
    }
    rows.add("neighbours", {{"radius", 10}, {"neighbours", 39}});
    rows.add("volumes", {{"volume", "AABB"},
                         {"frame", 0},
                         {"candidates", 3},
                         {"passed", 2},
                         {"touching", 1},
                         {"first_ms", 1},
                         {"exact_ms", 2}});
    return {{}, std::move(rows)};
}

// As the three figures are printed: rows by number of objects; un-optimized, then cells of 5, 10, 25,
// 50 and 100. The last of all is a misprint, "<!".
TEST(PrintedFigures, AreThoseOfThePaper) {
    PaperReport report = reportOfRows({});
    constexpr std::array kPrinted{
        "60+ 60+ 60+ 60+ 60+ 60+; 60+ 60+ 60+ 60+ 60+ 60+; 25 60+ 60+ 60+ 60+ 60+; "
        "<1 60+ 60+ 60+ 60+ 60+; <1 60+ 60+ 60+ 60+ 2; <1 60+ 60+ 50 5 <1; <1 29 23 <1 <1 <1",
        "60+ 60+ 60+ 60+ 60+ 60+; 60+ 60+ 60+ 60+ 60+ 60+; 48 60+ 60+ 60+ 60+ 60+; "
        "16 60+ 60+ 60+ 60+ 60+; <1 60+ 60+ 60+ 60+ 60+; <1 60+ 60+ 60+ 60 49; <1 60+ 60+ 60+ 52 "
        "40",
        "60+ 60+ 60+ 60+ 60+ 60+; 60+ 60+ 60+ 60+ 60+ 60+; 35 60+ 60+ 60+ 60+ 60+; "
        "<1 60+ 60+ 60+ 60+ 60+; <1 60+ 60+ 24 33 10; <1 23 28 12 <1 <1; <1 8 <1 <1 <1 <1"};
    for (const Phase phase : kPhases) {
        EXPECT_EQ(
            asked(report.measured,
                  "SELECT group_concat(printed, ' ') FROM (SELECT * FROM printed WHERE phase = '" +
                      std::string(nameOf(phase)) + "' ORDER BY objects, place) GROUP BY objects"),
            kPrinted[static_cast<std::size_t>(phase)]);
    }
    EXPECT_EQ(asked(report.measured, "SELECT DISTINCT objects FROM printed ORDER BY 1"),
              "500; 1,000; 2,500; 5,000; 10,000; 20,000; 50,000");
    EXPECT_EQ(asked(report.measured, "SELECT DISTINCT cell FROM printed ORDER BY place"),
              "-; 5; 10; 25; 50; 100");
    // No number is made of a censored value.
    EXPECT_EQ(asked(report.measured,
                    "SELECT DISTINCT printed, rate, is_too_slow FROM printed "
                    "WHERE printed IN ('60+', '<1', '49', '16', '23', '12') ORDER BY 1"),
              "12 12 1; 16 16 1; 23 23 0; 49 49 0; 60+ - 0; <1 - 1");
}

TEST(PaperTallies, CountThePapersSlowCellsByPhaseAndMethod) {
    PaperReport report = reportOfRows(kFigureRows);
    // Of collision, 2 of 20,000 with 60 ms, 3 of 50,000 with 50.
    EXPECT_EQ(
        asked(report.measured, "SELECT phase, columns, too_slow, paper, hashphase FROM real_time"),
        "collision grid 5 3 5; collision unoptimized 2 0 2; visibility grid 0 0 0; "
        "visibility unoptimized 2 2 2; AI grid 6 1 5; AI unoptimized 2 1 1");
    // The paper's grid is faster in visibility, and in AI of 10,000.
    EXPECT_EQ(
        asked(report.measured, "SELECT compared, lost, ratio, worst LIKE '% of %' FROM losses"),
        "30 15 3 1");
    std::vector<FigureRow> unmeasured = kFigureRows;
    for (FigureRow& row : unmeasured) {
        row.unoptimized = row.paperGrid = row.hashphase = 0;
    }
    PaperReport none = reportOfRows(unmeasured);
    EXPECT_EQ(asked(none.measured, "SELECT too_slow, paper, hashphase FROM real_time LIMIT 1"),
              "5 0 0");
    EXPECT_EQ(asked(none.measured, "SELECT compared, lost FROM losses"), "0 0");
}

TEST(PaperReport, ClaimsTheSameCellSizeOfCollisionAloneAndCountsNoVisibility) {
    PaperReport report = reportOfRows(kFigureRows);
    EXPECT_EQ(
        report.findings.verdict,
        "In real time: 13 of the paper's 15 slow results. All methods found the same as brute "
        "force: yes");
    EXPECT_EQ(
        asked(report.measured, "SELECT sentence FROM real_time_sentences"),
        "Slow results of collision, at the same cell size: hashphase computes 5 of 5 in real time, "
        "the paper's grid on this machine 3.; "
        "Slow results of AI, with cells chosen from the radius: hashphase computes 5 of 6 in real "
        "time, the paper's grid on this machine 1.; "
        "Slow results of un-optimized collision and AI, with automatic cells: hashphase computes 3 "
        "of "
        "4 in real time, un-optimized on this machine 1.; "
        "Figure 14 is not counted: the paper's times include drawing, and nothing is drawn here. "
        "Of its slow results, un-optimized computes 2 of 2 in real time on this machine, and "
        "hashphase 2.");
}

TEST(PaperReport, IsPrintedInLinesThatFitTheTerminalWithAShortVerdict) {
    PaperReport report = reportOfRows(kFigureRows);
    for (const auto& [columns, most] : {std::pair{0, 100}, {90, 90}, {300, 100}}) {
        std::ostringstream out;
        Console console{out, out, false, ""};
        console.columns = static_cast<std::size_t>(columns);
        printReport(report, false, console);
        std::istringstream lines(out.str());
        for (std::string line; std::getline(lines, line);) {
            EXPECT_LE(line.size(), static_cast<std::size_t>(most)) << line;
        }
        EXPECT_NE(out.str().find("\nIn real time: 13 of the paper's 15 slow results."),
                  std::string::npos);
    }
}

TEST(PaperReport, SaysOnWhichGroundHowManyRoam) {
    std::vector<FigureRow> rows = kFigureRows;
    rows.push_back({Phase::ai, 100'000, 1, 1, 1, "figure", 565.75});
    EXPECT_EQ(reportOfRows(rows).findings.sections.at(0).settings.at(0),
              "Spheres of radius 1 m roam a random terrain: up to 50,000 on 400 x 400 m with 3,200 "
              "triangles; 100,000 on 566 x 566 m with 4,526 triangles.");
}

TEST(PaperReport, DrawsTheLimitOfRealTimeAndNamesAnErrorBarOnlyWhereThereIsOne) {
    std::vector<FigureRow> rows = kFigureRows;
    rows.push_back({Phase::ai, 20'000, 1, 1, 1, "radius"});
    rows.push_back({Phase::collision, 20'000, 1, 1, 1, "cell size"});
    std::string limited;
    for (const PageSection& section : pageOf(reportOfRows(rows)).sections) {
        for (const Chart& chart : section.charts) {
            EXPECT_EQ(chart.settings.find("percentile") != std::string::npos,
                      chart.drawn.contains("low"))
                << chart.name;
            if (chart.drawn.contains("theory")) {
                EXPECT_EQ(chart.drawn.at("theory"), "limit");
                limited += chart.name + ' ';
                EXPECT_EQ(chart.data.rows.front().back(), Value(50.0));
            }
        }
    }
    EXPECT_EQ(limited, "paper-collision paper-visibility paper-AI paper-radius paper-cell-time ");
}

TEST(PaperTables, HaveTheAutomaticCellSizeAmongTheOthers) {
    PaperReport report = reportOfRows({{Phase::collision, 20'000, 0, 3, 2, "cell size"}});
    EXPECT_EQ(asked(report.measured, "SELECT * FROM cell_sizes LIMIT 2 OFFSET 4"),
              "paper's grid 100 3 3 3 1; hashphase, automatic cells 2.5 2 2 2 1");
}

TEST(PaperTables, GradeRatesAndHaveMillisecondsWhereTheyAreAskedFor) {
    const auto rowsOf = [](const GradedTable& table) {
        std::string text;
        for (const std::vector<GradedText>& row : table.rows) {
            for (const GradedText& cell : row) {
                text += cell.marked() + (cell.grade == Grade::kGood ? "* " : " ");
            }
        }
        return text;
    };
    const PaperReport report = reportOfRows(
        {{Phase::collision, 10'000, 3'200, 50.2, 16.7}, {Phase::collision, 7, 50, 0.81, 16.66}});
    const PageSection& section = report.findings.sections.at(1);
    EXPECT_EQ(section.heading, "Figure 13: collision");
    EXPECT_EQ(rowsOf(section.graded.at(0)),
              "7 paper, 2005 - - - - - -  7 paper, today 20~ 1,234* 1,234* 1,234* 1,234* 1,234*  "
              "7 hashphase  60* 60* 60* 60* 60* 60* "
              "10,000 paper, 2005 <1! 60+* 60+* 60+* 60+* 2!  "
              "10,000 paper, today 0.3! 19! 19! 19! 19! 19!  "
              "10,000 hashphase  59~ 59~ 59~ 59~ 59~ 59~ ");
    EXPECT_EQ(rowsOf(section.graded.at(1)),
              "7 paper, 2005 - - - - - -  7 paper, today 50.0~ 0.810* 0.810* 0.810* 0.810* 0.810*  "
              "7 hashphase  16.7* 16.7* 16.7* 16.7* 16.7* 16.7* "
              "10,000 paper, 2005 >1000! <=16.7* <=16.7* <=16.7* <=16.7* 500!  "
              "10,000 paper, today 3200! 50.2! 50.2! 50.2! 50.2! 50.2!  "
              "10,000 hashphase  16.7~ 16.7~ 16.7~ 16.7~ 16.7~ 16.7~ ");
    std::ostringstream out;
    writeGradedTable({"<b>",
                      {"a", "b", "c"},
                      {"n", "who", "m"},
                      {{{"1"}, {"x"}, {"<1", Grade::kPoor}}, {{"1"}, {"y"}, {"30", Grade::kFair}}}},
                     out);
    EXPECT_NE(out.str().find("<td class=\"number poor\">&lt;1!</td>"), std::string::npos)
        << out.str();
    EXPECT_NE(out.str().find("<td class=\"number fair\">30~</td>"), std::string::npos);
    EXPECT_NE(out.str().find("rowspan=\"2\">1</th>"), std::string::npos);
    EXPECT_EQ(out.str().find("<b>"), std::string::npos);
}

}  // namespace
}  // namespace hashphase::demos
