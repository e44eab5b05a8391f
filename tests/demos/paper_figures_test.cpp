// SPDX-License-Identifier: Zlib
#include <demos/paper/paper_report.hpp>
#include <demos/paper/paper_tables.hpp>

#include <gtest/gtest.h>

#include <array>
#include <sstream>

namespace hashphase::demos {
namespace {

// As the three figures are printed: rows by number of objects; un-optimized, then cells of 5, 10, 25,
// 50 and 100. The last of all is a misprint, "<!".
constexpr std::array<const char*, 3> kPrintedFigures{
    "60+ 60+ 60+ 60+ 60+ 60+\n"
    "60+ 60+ 60+ 60+ 60+ 60+\n"
    "25 60+ 60+ 60+ 60+ 60+\n"
    "<1 60+ 60+ 60+ 60+ 60+\n"
    "<1 60+ 60+ 60+ 60+ 2\n"
    "<1 60+ 60+ 50 5 <1\n"
    "<1 29 23 <1 <1 <1\n",
    "60+ 60+ 60+ 60+ 60+ 60+\n"
    "60+ 60+ 60+ 60+ 60+ 60+\n"
    "48 60+ 60+ 60+ 60+ 60+\n"
    "16 60+ 60+ 60+ 60+ 60+\n"
    "<1 60+ 60+ 60+ 60+ 60+\n"
    "<1 60+ 60+ 60+ 60 49\n"
    "<1 60+ 60+ 60+ 52 40\n",
    "60+ 60+ 60+ 60+ 60+ 60+\n"
    "60+ 60+ 60+ 60+ 60+ 60+\n"
    "35 60+ 60+ 60+ 60+ 60+\n"
    "<1 60+ 60+ 60+ 60+ 60+\n"
    "<1 60+ 60+ 24 33 10\n"
    "<1 23 28 12 <1 <1\n"
    "<1 8 <1 <1 <1 <1\n"};

TEST(PrintedFigures, AreThoseOfThePaper) {
    for (const Phase phase : kPhases) {
        std::istringstream printed(kPrintedFigures[static_cast<std::size_t>(phase)]);
        std::string rate;
        for (const std::uint32_t objects : kPrintedObjects) {
            printed >> rate;
            EXPECT_EQ(printedRate(phase, objects, std::nullopt), rate) << objects;
            for (const double cellSize : kPrintedCellSizes) {
                printed >> rate;
                EXPECT_EQ(printedRate(phase, objects, cellSize), rate)
                    << objects << ' ' << cellSize;
            }
        }
        EXPECT_TRUE(printed.good());
        EXPECT_FALSE(printed >> rate);
    }
    EXPECT_EQ(printedRate(Phase::ai, 30'000, 5.0), "");
    EXPECT_EQ(printedRate(Phase::ai, 500, 7.0), "");
}

TEST(PrintedFigures, NeverMakeANumberOfACensoredValue) {
    EXPECT_EQ(exactRate("60+"), std::nullopt);
    EXPECT_EQ(exactRate("<1"), std::nullopt);
    EXPECT_EQ(exactRate(""), std::nullopt);
    EXPECT_EQ(exactRate("49"), 49);
    EXPECT_FALSE(isTooSlow("60+"));
    EXPECT_TRUE(isTooSlow("<1"));
    EXPECT_TRUE(isTooSlow("19"));
    EXPECT_FALSE(isTooSlow("20"));
    EXPECT_EQ(gradeOfPrinted("60+"), Grade::kGood);
    EXPECT_EQ(gradeOfPrinted("60"), Grade::kGood);
    EXPECT_EQ(gradeOfPrinted("23"), Grade::kFair);
    EXPECT_EQ(gradeOfPrinted("<1"), Grade::kPoor);
    EXPECT_EQ(printedMilliseconds("60+"), "<=16.7");
    EXPECT_EQ(printedMilliseconds("<1"), ">1000");
    EXPECT_EQ(printedMilliseconds("25"), "40.0");
}

/// Of which a frame takes so long [ms].
MethodResult methodOf(MethodKind kind, std::optional<double> cellSize, double milliseconds) {
    MethodResult method;
    method.kind = kind;
    method.cellSize = cellSize;
    method.frameMs = {milliseconds};
    method.hashMs = {0};
    method.standMs = {0};
    return method;
}

/// Every cell of a row measured, with the same time for a method in all of them.
PhaseResult rowOf(Phase phase, std::uint32_t objects, double unoptimized, double paperGrid,
                  double hashphase) {
    PhaseResult row;
    row.task = {phase, objects, 1, 10};
    row.side = 400;
    row.triangles = 3'200;
    row.methods = {methodOf(MethodKind::unoptimized, std::nullopt, unoptimized),
                   methodOf(MethodKind::hashphase, std::nullopt, hashphase)};
    for (const double cellSize : kPrintedCellSizes) {
        row.methods.push_back(methodOf(MethodKind::paperGrid, cellSize, paperGrid));
        row.methods.push_back(methodOf(MethodKind::hashphase, cellSize, hashphase));
    }
    return row;
}

PaperResults resultsOfRows() {
    PaperResults results;
    results.checks = {{"", CheckOutcome::holds, ""}};
    results.figures = {rowOf(Phase::collision, 20'000, 900, 60, 10),
                       rowOf(Phase::collision, 50'000, 5'000, 50, 49),
                       rowOf(Phase::visibility, 5'000, 0.2, 0.1, 0.3),
                       rowOf(Phase::visibility, 50'000, 2, 1, 2),
                       rowOf(Phase::ai, 10'000, 40, 20, 60),
                       rowOf(Phase::ai, 50'000, 99, 98, 8)};
    return results;
}

void expectCells(const CellTally& cells, std::size_t tooSlow, std::size_t today,
                 std::size_t hashphase) {
    EXPECT_EQ(cells.tooSlow, tooSlow);
    EXPECT_EQ(cells.today, today);
    EXPECT_EQ(cells.hashphase, hashphase);
}

TEST(PaperTallies, CountThePapersSlowCellsByPhaseAndMethod) {
    const RealTimeTally tally = tallyRealTime(resultsOfRows());
    expectCells(tally.grid[0], 5, 3, 5);  // 2 of 20,000 with 60 ms, 3 of 50,000 with 50
    expectCells(tally.grid[1], 0, 0, 0);
    expectCells(tally.grid[2], 6, 1, 5);
    expectCells(tally.unoptimized[0], 2, 0, 2);
    expectCells(tally.unoptimized[1], 2, 2, 2);
    expectCells(tally.unoptimized[2], 2, 1, 1);
}

TEST(PaperTallies, CountOnlyWhatIsMeasured) {
    PaperResults results = resultsOfRows();
    for (PhaseResult& row : results.figures) {
        for (MethodResult& method : row.methods) {
            method.frameMs.clear();
        }
    }
    const RealTimeTally tally = tallyRealTime(results);
    expectCells(tally.grid[0], 5, 0, 0);
    EXPECT_EQ(tallyLosses(results).compared, 0U);
    EXPECT_EQ(tallyLosses(results).lost, 0U);
}

TEST(PaperTallies, CountWhereThePapersGridIsFaster) {
    const LossTally losses = tallyLosses(resultsOfRows());
    EXPECT_EQ(losses.compared, 30U);
    EXPECT_EQ(losses.lost, 15U);  // visibility, and AI of 10,000
    EXPECT_DOUBLE_EQ(losses.worstRatio, 3);
    EXPECT_NE(losses.worst.find("of "), std::string::npos);
}

TEST(PaperReport, ClaimsTheSameCellSizeOfCollisionAloneAndCountsNoVisibility) {
    const std::string verdict = verdictLine(resultsOfRows());
    EXPECT_NE(verdict.find("5 of 5 of collision at the same cell size (the paper's grid on this "
                           "machine 3)"),
              std::string::npos)
        << verdict;
    EXPECT_NE(
        verdict.find("5 of 6 of AI, by cells that follow the radius (the paper's grid on this "
                     "machine 1)"),
        std::string::npos)
        << verdict;
    EXPECT_NE(verdict.find("3 of 4 un-optimized ones of collision and AI, by automatic cells "
                           "(un-optimized on this machine 1)"),
              std::string::npos)
        << verdict;
    EXPECT_NE(verdict.find("Figure 14 is not counted"), std::string::npos) << verdict;
    EXPECT_NE(verdict.find("brute force: yes"), std::string::npos) << verdict;
}

TEST(PaperReport, SaysOnWhichGroundHowManyRoam) {
    PaperResults results = resultsOfRows();
    results.figures.push_back(rowOf(Phase::ai, 100'000, 1, 1, 1));
    results.figures.back().side = 565.7F;
    results.figures.back().triangles = 6'498;
    EXPECT_EQ(howItWasMeasured(results)[0],
              "Spheres of radius 1 roam a random terrain: up to 50,000 on 400 x 400 m, of 3,200 "
              "triangles; 100,000 on 566 x 566 m, of 6,498 triangles.");
}

TEST(PaperReport, DrawsTheLimitOfRealTimeInEveryChartOfFrames) {
    PaperReport report;
    report.results = resultsOfRows();
    const Page page = pageOf(report);
    std::size_t charts = 0;
    for (const PageSection& section : page.sections) {
        for (const Chart& chart : section.charts) {
            ++charts;
            ASSERT_EQ(chart.theory, "limit") << chart.name;
            EXPECT_EQ(chart.data.rows.front().back(), Value(50.0));
        }
    }
    EXPECT_EQ(charts, 3U);
}

TEST(PaperReport, NamesAnErrorBarOnlyWhereOneIsDrawn) {
    PaperReport report;
    report.results = resultsOfRows();
    report.results.radii = {rowOf(Phase::ai, 20'000, 1, 1, 1)};
    report.results.neighbours = {39};
    report.results.cellSizes = rowOf(Phase::collision, 20'000, 1, 1, 1);
    report.results.volumes = {100, 1, {{VolumeKind::aabb, {1}, {1}, 1, 1, 1}}, {}};
    for (const PageSection& section : pageOf(report).sections) {
        for (const Chart& chart : section.charts) {
            EXPECT_EQ(chart.settings.find("percentile") != std::string::npos, !chart.low.empty())
                << chart.name;
        }
    }
}

TEST(PaperTables, HaveTheAutomaticCellSizeAmongTheOthers) {
    PaperResults results;
    results.cellSizes.methods = {methodOf(MethodKind::hashphase, 5.0, 2),
                                 methodOf(MethodKind::hashphase, std::nullopt, 1)};
    results.cellSizes.methods[0].bytes = 1 << 20;
    results.cellSizes.methods[1].bytes = 2 << 20;
    results.cellSizes.methods[1].chosenCellSize = 2.5;
    const DataTable table = cellSizeTable(results);
    ASSERT_EQ(table.rows.size(), 2U);
    EXPECT_EQ(table.rows[1][0], Value(std::string("hashphase, automatic cells")));
    EXPECT_EQ(table.rows[1][1], Value(2.5));
    EXPECT_EQ(table.rows[1][5], Value(2.0));
}

TEST(PaperTables, HaveMillisecondsInEveryRowWhereTheyAreAskedFor) {
    PaperResults results;
    results.figures = {rowOf(Phase::collision, 10'000, 100, 10, 5)};
    const GradedTable table = figureTable(results, Phase::collision, true);
    EXPECT_EQ(table.rows[0][2].text, ">1000");
    EXPECT_EQ(table.rows[0][3].text, "<=16.7");
    EXPECT_EQ(table.rows[0][7].text, "500");
    EXPECT_EQ(table.rows[1][3].text, "10.0");
    EXPECT_EQ(figureTable(results, Phase::collision, false).rows[0][7].text, "2");
}

TEST(PaperTables, MarkWhatIsTooSlow) {
    EXPECT_EQ(gradeOf(60.0), Grade::kGood);
    EXPECT_EQ(gradeOf(59.9), Grade::kFair);
    EXPECT_EQ(gradeOf(20.0), Grade::kFair);
    EXPECT_EQ(gradeOf(19.9), Grade::kPoor);
    EXPECT_EQ(gradeOf(std::nullopt), Grade::kNone);
    EXPECT_EQ(rateText(1234.6), "1,234");
    EXPECT_EQ(rateText(59.9), "59");
    EXPECT_EQ(rateText(0.31), "0.3");
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
