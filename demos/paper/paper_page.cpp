// SPDX-License-Identifier: Zlib
#include <demos/console/format.hpp>
#include <demos/paper/paper_report.hpp>
#include <demos/paper/paper_tables.hpp>
#include <demos/report/page.hpp>

#include <algorithm>

namespace hashphase::demos {
namespace {

constexpr const char* kPaperIntroduction =
    "Hastings, Mesit and Guha, \"Optimization of Large-Scale, Real-Time Simulations by Spatial "
    "Hashing\", timed three phases of a simulation of spheres that roam a terrain. This page puts "
    "what they printed beside what their methods do on this machine, and beside hashphase, a "
    "spatial "
    "hash that replaces the broadphase of the Bullet physics engine.";

std::string medianSettings(std::uint32_t frames) {
    return "medians of up to " + withThousands(frames) + " frames; one thread";
}

std::string spreadSettings(const PaperResults& results) {
    return "medians of up to " + withThousands(results.plan.effort.frames) +
           " frames, 5th to 95th percentile; one thread";
}

/// A line at the time of a frame that is just real-time.
void addRealTimeRule(Chart& chart) {
    constexpr double kSecond = 1000;  // [ms]
    const double limit = kSecond / kRealTimeRate;
    chart.theory = "limit";
    chart.data.columns.push_back(
        {chart.theory, fixed(kRealTimeRate, 0) + " frames a second: " + fixed(limit, 0) + " ms"});
    for (std::vector<Value>& row : chart.data.rows) {
        row.emplace_back(limit);
    }
}

/// Time over the number of objects; of the fixed sizes, the paper's smallest and largest cells.
Chart scalingChart(const PaperResults& results, Phase phase) {
    Chart chart;
    chart.name = "paper-" + std::string(nameOf(phase));
    chart.title = "Time a frame by number of objects: " + std::string(nameOf(phase));
    chart.settings = spreadSettings(results);
    chart.data.columns = {
        {"method", "method"}, {"objects", "objects"}, {"ms", "frame [ms]"}, {"low"}, {"high"}};
    const auto addMethod = [&](MethodKind kind, std::optional<double> cellSize) {
        for (const PhaseResult& result : results.figures) {
            const MethodResult* method =
                result.task.phase == phase ? result.find(kind, cellSize) : nullptr;
            if (method != nullptr && method->isMeasured()) {
                const Spread time = method->time();
                chart.data.add({describe(*method), static_cast<double>(result.task.objects),
                                time.median, time.low, time.high});
            }
        }
    };
    addMethod(MethodKind::unoptimized, std::nullopt);
    for (const MethodKind kind : {MethodKind::paperGrid, MethodKind::hashphase}) {
        addMethod(kind, kPrintedCellSizes.front());
        addMethod(kind, kPrintedCellSizes.back());
    }
    addMethod(MethodKind::hashphase, std::nullopt);
    chart.x = {"objects", AxisScale::kLog};
    chart.y = {"ms", AxisScale::kLog};
    chart.series = "method";
    chart.low = "low";
    chart.high = "high";
    addRealTimeRule(chart);
    return chart;
}

PageSection figureSection(const PaperResults& results, Phase phase) {
    PageSection section;
    section.heading =
        "Figure " + std::to_string(figureNumber(phase)) + ": " + std::string(nameOf(phase));
    section.sentences = {"The paper timed " + std::string(paperScope(phase)) +
                         ". Timed here: " + std::string(scopeOf(phase)) + "."};
    section.graded = {figureTable(results, phase, false), figureTable(results, phase, true)};
    section.charts = {scalingChart(results, phase)};
    return section;
}

PageSection radiusSection(const PaperResults& results) {
    PageSection section;
    section.heading = "AI by radius";
    section.sentences = {
        "The paper does not say within which radius its agents look; how many they see, and so "
        "what "
        "it costs, grows with its square."};
    Chart chart;
    chart.name = "paper-radius";
    chart.title = "Time of an AI frame by radius";
    chart.settings = withThousands(results.plan.sweepObjects) + " objects; " +
                     medianSettings(results.plan.effort.frames);
    chart.data.columns = {{"method", "method"}, {"radius", "radius [m]"}, {"ms", "frame [ms]"}};
    for (std::size_t i = 0; i < results.radii.front().methods.size(); ++i) {
        for (const PhaseResult& result : results.radii) {
            const MethodResult& method = result.methods[i];
            if (method.isMeasured()) {
                chart.data.add({describe(method), static_cast<double>(result.task.aiRadius),
                                method.time().median});
            }
        }
    }
    chart.x = {"radius", AxisScale::kLog};
    chart.y = {"ms", AxisScale::kLog};
    chart.series = "method";
    addRealTimeRule(chart);
    section.charts = {chart};
    section.tables = {radiusTable(results)};
    return section;
}

PageSection cellSizeSection(const PaperResults& results) {
    PageSection section;
    section.heading = "Cell size: time against memory";
    section.sentences = {
        "The paper expects small cells to be fast and to take more memory, since objects span more "
        "of "
        "them, and leaves the trade-off open. hashphase files each object once, so its memory does "
        "not follow the cell size; what is crowded is sorted within its cell."};
    const MethodResult* automatic = results.cellSizes.find(MethodKind::hashphase, std::nullopt);
    if (automatic != nullptr && automatic->bytes && automatic->chosenCellSize) {
        section.conclusions = {"Hashphase chooses cells of " +
                               fixed(*automatic->chosenCellSize, 1) + " m, and takes " +
                               milliseconds(automatic->time().median) + " ms a frame and " +
                               byteSize(static_cast<std::int64_t>(*automatic->bytes)) + "."};
    }
    Chart time;
    time.name = "paper-cell-time";
    time.title = "Time of a collision frame by cell size";
    time.settings =
        withThousands(results.plan.sweepObjects) + " objects; " + spreadSettings(results);
    time.data = cellSizeTable(results);
    time.x = {"cell", AxisScale::kLog};
    time.y = {"ms", AxisScale::kLog};
    time.series = "method";
    time.low = "low";
    time.high = "high";
    Chart memory = time;
    memory.name = "paper-cell-memory";
    memory.title = "Memory of the collision phase by cell size";
    memory.settings = withThousands(results.plan.sweepObjects) +
                      " objects; all that a method keeps, its pairs and its terrain included";
    memory.y = {"mebibytes", AxisScale::kLog};
    memory.low.clear();
    memory.high.clear();
    addRealTimeRule(time);
    section.charts = {time, memory};
    return section;
}

PageSection volumeSection(const PaperResults& results) {
    PageSection section;
    section.heading = "Bounding volumes as a first pass";
    section.sentences = {
        "Sticks of 4 m, 0.4 m thick, turn in space. The grid files the box of each volume; pairs "
        "whose boxes overlap are candidates, those whose volumes do pass, and the exact test says "
        "which of them touch. A volume that fits passes fewer in vain, and takes longer to "
        "compare."};
    const std::string objects = withThousands(results.volumes.sticks) + " sticks, 30 m^3 for each";
    Chart pairs;
    pairs.name = "paper-volumes-pairs";
    pairs.title = "Pairs that the first pass lets through in vain";
    pairs.settings = objects + "; means of " + withThousands(results.volumes.frames) + " frames";
    pairs.mark = ChartMark::kBar;
    pairs.data = volumeTable(results);
    pairs.x = {"volume", AxisScale::kNames};
    pairs.y = {"false", AxisScale::kLinear};
    Chart time = pairs;
    time.name = "paper-volumes-time";
    time.title = "Time of a frame, the exact test included";
    time.settings = objects + "; " + medianSettings(results.volumes.frames);
    time.y = {"ms", AxisScale::kLinear};
    section.charts = {pairs, time};
    section.tables = {volumeTable(results)};
    return section;
}

PageSection fewFramesSection(const PaperResults& results) {
    PageSection section;
    section.heading = "What was timed in fewer frames";
    section.sentences = {"Everything else was timed in " +
                         withThousands(results.plan.effort.frames) + " different frames."};
    section.tables = {fewFramesTable(results)};
    return section;
}

PageSection checkSection(const PaperResults& results) {
    PageSection section;
    section.heading = "Whether it is right";
    section.sentences = {
        "What every method found, pairs, bounces and heights, visible objects, colours, is "
        "compared with brute force in the same frame."};
    section.conclusions = observations(results);
    for (const PaperCheck& check : results.checks) {
        if (check.outcome == CheckOutcome::notChecked) {
            section.conclusions.push_back("Not checked: " + check.claim + " (" + check.evidence +
                                          ").");
        } else {
            section.checks.push_back(
                {check.claim, check.outcome == CheckOutcome::holds, check.evidence});
        }
    }
    for (const std::string& each : results.leftOut) {
        section.conclusions.push_back("Left out for want of time: " + each + ".");
    }
    section.settings = howItWasMeasured(results);
    return section;
}

}  // namespace

Page pageOf(const PaperReport& report) {
    const PaperResults& results = report.results;
    Page page{
        "The paper's figures, then and today", kPaperIntroduction,      verdictLine(results) + ".",
        whetherItHolds(results.outcome()),     {checkSection(results)}, report.provenance};
    for (const Phase phase : kPhases) {
        page.sections.push_back(figureSection(results, phase));
    }
    if (!results.radii.empty()) {
        page.sections.push_back(radiusSection(results));
    }
    if (!results.cellSizes.methods.empty()) {
        page.sections.push_back(cellSizeSection(results));
    }
    if (!results.volumes.volumes.empty()) {
        page.sections.push_back(volumeSection(results));
    }
    if (!fewFramesTable(results).rows.empty()) {
        page.sections.push_back(fewFramesSection(results));
    }
    return page;
}

}  // namespace hashphase::demos
