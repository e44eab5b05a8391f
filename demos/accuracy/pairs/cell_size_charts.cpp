// SPDX-License-Identifier: Zlib
#include <demos/accuracy/pairs/cell_size_charts.hpp>

#include <demos/accuracy/pairs/pair_findings.hpp>
#include <demos/console/format.hpp>

#include <algorithm>
#include <cctype>

namespace hashphase::demos {
namespace {

Chart heatMap(std::span<const CellCaseResult> results, bool isTime) {
    Chart chart;
    chart.name = isTime ? "P2-time" : "P2-memory";
    chart.title = isTime ? "Time an object and frame, by the size of the finest cells"
                         : "Memory an object, by the size of the finest cells";
    chart.settings = cellSizeSettings();
    chart.mark = ChartMark::kCell;
    chart.data.columns = {{"cell", "cell / mean edge"},
                          {"population", "population, objects"},
                          isTime ? DataColumn{"ns", "time [ns/object]"}
                                 : DataColumn{"bytes", "memory [bytes/object]"}};
    chart.x = {"cell", AxisScale::kNames};
    chart.y = {"population", AxisScale::kNames};
    chart.shade = {isTime ? "ns" : "bytes", AxisScale::kLog};
    for (const CellCaseResult& result : results) {
        for (std::size_t i = 0; i < result.methods.size(); ++i) {
            const CellMethod& method = result.methods[i];
            if (method.isFixed() || method.isAutomatic) {
                chart.data.add(
                    {method.factor ? factorText(*method.factor) : "automatic", result.name,
                     valueOf(isTime ? result.nanosecondsOf(i) : result.bytesPerObject(i))});
            }
        }
    }
    return chart;
}

/// For names of files.
std::string slugOf(const CellCaseResult& result) {
    std::string slug = result.population + "-" + std::to_string(result.objects);
    std::replace_if(
        slug.begin(), slug.end(), [](unsigned char letter) { return std::isalnum(letter) == 0; },
        '-');
    return slug;
}

/// All that was measured on one population, missed and false pairs apart.
DataTable resultTable(const CellCaseResult& result) {
    DataTable table{pairColumns(), {}};
    table.columns.insert(table.columns.begin(),
                         {{"method", "method"}, {"cell", "cell / mean edge"}});
    table.columns.push_back({"tests", "boxes compared a true pair"});
    table.columns.push_back({"bytes", "memory [bytes/object]"});
    const auto bullet = result.bullet();
    std::optional<double> bulletTime;
    if (bullet) {
        bulletTime = result.nanosecondsOf(*bullet);
    }
    for (std::size_t i = 0; i < result.methods.size(); ++i) {
        const CellMethod& method = result.methods[i];
        const PairMeasurement& measured = result.trial.measurements[i];
        std::vector<Value> row = pairValues(measured, result.nanosecondsOf(i), bulletTime);
        row.insert(row.begin(), {method.pairs.name, valueOf(method.factor)});
        const double framePairs = static_cast<double>(measured.truePairs) / measured.judgedFrames;
        std::optional<double> tests;
        if (measured.testsPerFrame && framePairs > 0) {
            tests = *measured.testsPerFrame / framePairs;
        }
        row.push_back(valueOf(tests));
        row.push_back(valueOf(result.bytesPerObject(i)));
        table.add(std::move(row));
    }
    return table;
}

}  // namespace

std::string cellSizeSettings() {
    return "Edges of 0.5-1.5 m, or of 1-1000 m with as many of each order of magnitude; each box "
           "overlaps about two others and moves by up to a fifth of the mean edge on each axis and "
           "frame; clusters hold 1,000 boxes. setAabb for all and all pairs of a frame, the pair "
           "cache included (the paper's grids keep none); medians of 60 frames.";
}

std::string factorText(double factor) {
    return fixed(factor, factor < 0.5 ? 2 : factor < 1 ? 1 : 0);
}

DataTable regretTable(std::span<const CellCaseResult> results) {
    DataTable table{{{"population", "population"},
                     {"automatic_ns", "automatic [ns/object]"},
                     {"best_ns", "best fixed [ns/object]"},
                     {"best_cell", "best cell / mean edge"},
                     {"regret_percent", "automatic is slower by [%]"}},
                    {}};
    for (const CellCaseResult& result : results) {
        const auto ours = result.automatic();
        const auto best = result.bestFixed();
        if (ours && best) {
            table.add({result.name, *result.nanosecondsOf(*ours), *result.nanosecondsOf(*best),
                       factorText(*result.methods[*best].factor), 100 * *result.regret()});
        }
    }
    return table;
}

std::vector<Chart> overviewCharts(std::span<const CellCaseResult> results) {
    Chart regret;
    regret.name = "P2-regret";
    regret.title =
        "By how much the automatic cells are slower than the best fixed ones (below zero: "
        "faster)";
    regret.settings = cellSizeSettings();
    regret.mark = ChartMark::kBar;
    regret.data = regretTable(results);
    regret.x = {"population", AxisScale::kNames};
    regret.y = {"regret_percent", AxisScale::kLinear};
    return {heatMap(results, true), heatMap(results, false), regret};
}

std::vector<Chart> caseCharts(const CellCaseResult& result) {
    Chart errors;
    errors.name = "P2-missed-" + slugOf(result);
    errors.title = "Missed pairs against time: " + result.name + " boxes";
    errors.settings = cellSizeSettings();
    errors.mark = ChartMark::kPoint;
    errors.data = resultTable(result);
    errors.x = {"ns", AxisScale::kLog};
    errors.y = {"missed_share", AxisScale::kLogAndZero};
    errors.series = "method";
    errors.low = "missed_low";
    errors.high = "missed_high";
    errors.label = "cell";
    errors.showFront = true;

    Chart tests = errors;
    tests.name = "P2-tests-" + slugOf(result);
    tests.title = "Boxes compared for each true pair, by cell size: " + result.name + " boxes";
    tests.mark = ChartMark::kLine;
    std::erase_if(tests.data.rows, [&](const std::vector<Value>& row) {
        return std::holds_alternative<std::monostate>(row[tests.data.columnOf("cell")]);
    });
    tests.x = {"cell", AxisScale::kLog};
    tests.y = {"tests", AxisScale::kLog};
    tests.low.clear();
    tests.high.clear();
    tests.label.clear();
    tests.showFront = false;
    return {errors, tests};
}

}  // namespace hashphase::demos
