// SPDX-License-Identifier: Zlib
#include <demos/report/chart_axis.hpp>
#include <demos/report/chart_front.hpp>
#include <demos/report/chart_labels.hpp>
#include <demos/report/series_looks.hpp>
#include <demos/report/vega_lite.hpp>
#include <tests/demos/sample_experiments.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace hashphase::demos {
namespace {

using Ticks = std::vector<double>;

Chart chartOf(const std::vector<double>& xs, const std::vector<double>& ys, AxisScale scale) {
    Chart chart{"c", "t", "s", ChartMark::kPoint, {{{"x"}, {"y"}}, {}}, {"x"}, {"y", scale}};
    for (std::size_t i = 0; i < xs.size(); ++i) {
        chart.data.add({xs[i], ys[i]});
    }
    return chart;
}

TEST(LogTicks, AreDecadesAndFewerOfThemWhereTheyAreMany) {
    EXPECT_EQ(logTicks(0.005, 700), (Ticks{0.01, 0.1, 1, 10, 100}));
    const Ticks many = logTicks(1e-12, 1e12);
    EXPECT_GE(many.size(), 3U);
    EXPECT_LE(many.size(), 8U);
}

TEST(LogTicks, AreRoundNumbersWithinADecade) {
    EXPECT_EQ(logTicks(0.9, 30), (Ticks{1, 2, 5, 10, 20}));
    EXPECT_EQ(logTicks(2.05, 2.95), (Ticks{2.2, 2.4000000000000004, 2.6, 2.8000000000000003}));
    EXPECT_EQ(logTicks(3, 3), (Ticks{3}));
}

TEST(ChartAxis, PutsZeroApartBelowTheSmallestNumber) {
    const Chart chart = chartOf({1, 2, 3}, {0, 0.01, 1}, AxisScale::kLogAndZero);
    const ChartAxis axis(chart, chart.y, {"y"});
    const double zero = axis.position(0.0);
    ASSERT_TRUE(axis.gap());
    EXPECT_LT(axis.begin(), zero);
    EXPECT_LT(zero, *axis.gap());
    EXPECT_LT(*axis.gap(), 0.01);
    EXPECT_EQ(axis.position(0.01), 0.01);
    EXPECT_NEAR(axis.share(zero), 0.03, 0.01);
}

TEST(ChartAxis, HasNoGapWhereThereIsNoZero) {
    const Chart chart = chartOf({1, 2}, {0.5, 1}, AxisScale::kLogAndZero);
    EXPECT_FALSE(ChartAxis(chart, chart.y, {"y"}).gap());
}

TEST(ChartAxis, IsStraightWhereAllIsZeroOrNothing) {
    for (const std::vector<double>& ys :
         {std::vector<double>{0, 0}, std::vector<double>{NAN, NAN}}) {
        const Chart chart = chartOf({1, 2}, ys, AxisScale::kLogAndZero);
        const ChartAxis axis(chart, chart.y, {"y"});
        EXPECT_FALSE(axis.isLog());
        EXPECT_EQ(axis.encoding("y")["scale"]["type"], "linear");
    }
}

TEST(ChartAxis, DrawsNothingForWhatALogarithmDoesNotReach) {
    const Chart chart = chartOf({1, 2}, {0, 5}, AxisScale::kLog);
    const ChartAxis axis(chart, chart.y, {"y"});
    EXPECT_TRUE(axis.position(0.0).is_null());
    EXPECT_TRUE(axis.position(Value()).is_null());
    EXPECT_EQ(axis.position(5.0), 5);
}

TEST(ChartFront, HoldsThePointsThatNoOtherBeatsInBoth) {
    const Chart chart = chartOf({3, 1, 2, 4, 2, 5}, {1, 9, 4, 1, 5, NAN}, AxisScale::kLinear);
    EXPECT_EQ(frontRows(chart), (std::vector<std::size_t>{1, 2, 0}));
}

TEST(ChartLabels, KeepApartFromEachOtherAndFromTheSides) {
    const std::vector<LabelledPoint> points{
        {100, 100, "label"}, {100, 100, "label"}, {100, 100, "label"}, {398, 100, "at the side"}};
    const std::vector<LabelPlace> places = placeLabels(points, 400);
    std::set<std::pair<double, double>> offsets;
    for (std::size_t i = 0; i < 3; ++i) {
        offsets.insert({places[i].dx, places[i].dy});
    }
    EXPECT_EQ(offsets.size(), 3U);
    EXPECT_STREQ(places[3].align, "right");
}

TEST(SeriesLooks, AreTheSameInAllChartsAndDifferWithinOne) {
    std::vector<Chart> charts(
        3, Chart{"c", "t", "s", ChartMark::kLine, {{{"m"}, {"x"}}, {}}, {"x"}, {"x"}, "m"});
    const auto name = [](int i) { return "method " + std::to_string(i); };
    for (int i = 0; i < 7; ++i) {
        charts[0].data.add({name(i), 1.0});
    }
    for (int i = 6; i < 13; ++i) {
        charts[1].data.add({name(i), 1.0});
    }
    for (int i = 13; i < 40; ++i) {
        charts[2].data.add({name(i), 1.0});
    }
    const SeriesLooks looks =
        seriesLooks(std::vector<const Chart*>{&charts[0], &charts[1], &charts[2]});
    EXPECT_EQ(looks.size(), 40U);
    for (std::size_t chart = 0; chart < 2; ++chart) {
        std::set<std::size_t> colours;
        for (const std::string& each : seriesOf(charts[chart])) {
            colours.insert(looks.at(each).colour);
        }
        EXPECT_EQ(colours.size(), 7U) << "chart " << chart;
    }
    std::set<std::pair<std::size_t, std::size_t>> both;
    for (const std::string& each : seriesOf(charts[2])) {
        both.insert({looks.at(each).colour, looks.at(each).shape});
    }
    EXPECT_EQ(both.size(), 27U);
}

TEST(VegaLite, HoldsEveryRowAndNeverInvertsAnAxis) {
    for (const Chart& chart : sampleCharts()) {
        const Json spec = vegaLiteSpec(chart, {}, pictureTheme(), ChartTitle::kInside);
        EXPECT_EQ(spec["data"]["values"].size(), chart.data.rows.size()) << chart.name;
        EXPECT_EQ(spec.dump().find("\"reverse\""), std::string::npos) << chart.name;
        EXPECT_EQ(spec.dump().find("var(--"), std::string::npos) << chart.name;
        EXPECT_EQ(spec["title"]["subtitle"][0], chart.settings) << chart.name;
    }
}

TEST(VegaLite, EscapesColumnsThatVegaWouldReadAsPaths) {
    Chart chart = chartOf({1}, {2}, AxisScale::kLinear);
    chart.data.columns.push_back({"method.of[x]"});
    chart.data.rows[0].push_back("m");
    chart.series = "method.of[x]";
    const std::string spec = vegaLiteSpec(chart, {}, pictureTheme(), ChartTitle::kNone).dump();
    EXPECT_NE(spec.find(R"("field":"method\\.of\\[x\\]")"), std::string::npos) << spec;
}

}  // namespace
}  // namespace hashphase::demos
