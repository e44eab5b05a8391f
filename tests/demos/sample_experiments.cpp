// SPDX-License-Identifier: Zlib
#include <tests/demos/sample_experiments.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace hashphase::demos {
namespace {

const std::array<std::string, 3> kMethods{"Sweep::discrete", "Sweep::line",
                                          "Bullet's <CCD> & \"more\""};

// Shares that fall to 0, with error bars and a theory.
Chart lines() {
    Chart chart{
        "S1-lines",
        "What moves further in a step than a wall is thick goes through it, unless the step "
        "is swept",
        "Walls from 1 mm to 1 m, 20,000 shots each, seed 1.",
        {{{"method", "method"},
          {"ratio", "step / thickness"},
          {"missed", "missed contacts"},
          {"low", "low"},
          {"high", "high"},
          {"theory", "theory: 1 - (T + 2r) / (v dt)"}},
         {}},
        {{"mark", "line"},
         {"x", "ratio log"},
         {"y", "missed log0"},
         {"series", "method"},
         {"low", "low"},
         {"high", "high"},
         {"theory", "theory"}}};
    for (const std::string& method : kMethods) {
        const double factor = method == kMethods[0] ? 1 : method == kMethods[1] ? 0 : 0.003;
        for (double ratio = 0.125; ratio <= 1024; ratio *= 2) {
            const double truth = std::max(0.0, 1 - 1 / ratio);
            const double missed = factor * truth;
            chart.data.add(
                {method, ratio, missed, missed * 0.8, std::max(1e-4, missed * 1.2), truth});
        }
    }
    return chart;
}

Chart points() {
    Chart chart{"S1-front",
                "Less time costs accuracy",
                "30,000 boxes, 60 frames.",
                {{{"method", "method"},
                  {"ms", "time [ms a frame]"},
                  {"missed", "missed [%]"},
                  {"step", "time step"}},
                 {}},
                {{"mark", "point"},
                 {"x", "ms log"},
                 {"y", "missed log0"},
                 {"series", "method"},
                 {"label", "step"},
                 {"front", "true"}}};
    int i = 0;
    for (const std::string& method : kMethods) {
        ++i;
        for (int step = 30; step <= 240; step *= 2) {
            const double missed = i == 2 && step == 240 ? 0 : 30.0 / step * i;
            chart.data.add({method, 0.02 * step / i, missed, "1/" + std::to_string(step) + " s"});
        }
    }
    chart.data.add({kMethods[0], Value(), 1.0, "not timed"});
    return chart;
}

/// Bars, or points on lines of their own.
Chart byName(const std::string& name, const std::string& mark, const std::string& ending) {
    Chart chart{name,
                "Objects that are in sight and are not drawn, or are drawn and out of sight",
                "50,000 objects, 100 cameras.",
                {{{"test", "test"},
                  {"camera", "camera"},
                  {"culled", "falsely culled"},
                  {"low", "low"},
                  {"high", "high"}},
                 {}},
                {{"mark", mark},
                 {"x", "test names"},
                 {"y", mark == "bar" ? "culled" : "culled log0"},
                 {"series", "camera"},
                 {"low", "low"},
                 {"high", "high"}}};
    for (const std::string test : {"corners", "planes", "exact"}) {
        for (const std::string camera : {"level", "looking down"}) {
            const double culled = test == "exact" ? 0 : test == "planes" ? 0.02 : 0.3;
            chart.data.add(
                {test + ending, camera + " (" + mark + "s)", culled, culled / 1.3, culled * 1.3});
        }
    }
    return chart;
}

Chart cells() {
    Chart chart{
        "S1-cells",
        "Time by cell size and number",
        "Uniform boxes.",
        {{{"number", "objects"}, {"cell", "cell / mean extent"}, {"ms", "time [ns an object]"}},
         {}},
        {{"mark", "cell"}, {"x", "number names"}, {"y", "cell names"}, {"shade", "ms log"}}};
    for (const double number : {1000.0, 10000.0, 100000.0, 1000000.0}) {
        for (double cell = 0.25; cell <= 64; cell *= 2) {
            const Value time = cell == 64 && number == 1000
                                   ? Value()
                                   : Value(40 * std::pow(number, 0.1) * (cell / 2 + 2 / cell));
            chart.data.add({number, cell, time});
        }
    }
    return chart;
}

// One series, straight axes.
Chart plainLine() {
    Chart chart{"S1-plain",
                "A line",
                "None.",
                {{{"slope", "slope [degrees]"}, {"depth"}}, {}},
                {{"x", "slope"}, {"y", "depth"}}};
    for (int slope = 0; slope <= 80; slope += 10) {
        chart.data.add({static_cast<double>(slope), 1 - std::cos(slope * 3.14159 / 180)});
    }
    return chart;
}

Findings sampleFindings() {
    Findings findings;
    findings.settings = {"Nothing is measured."};
    findings.charts = sampleCharts();
    findings.tables = {{{{"scene", "scene"}, {"hash", "hash equal"}},
                        {{"pile </script>", "yes"}, {"stack", 1234567.0}}}};
    findings.checks = {{"Swept modes miss nothing", true, "0 of 1,000,000"}};
    findings.choices = {{"Fast movers", kMethods[0], 1, 0.5, "misses half", true},
                        {"Fast movers", kMethods[2], 3, 0.2, "misses a fifth", false},
                        {"Fast movers", kMethods[1], 2, 0, "misses nothing", true}};
    findings.conclusions = {"Sweeping along a line costs twice as much & misses nothing."};
    return findings;
}

}  // namespace

std::vector<Chart> sampleCharts() {
    return {
        lines(),
        points(),
        byName("S1-bars", "bar", ""),
        byName("S1-dots", "point", " that have a name of some length to be written beside them"),
        cells(),
        plainLine()};
}

std::vector<Experiment> sampleExperiments() {
    return {{"S1", "Samples", "What do charts look like?", 1, 2,
             [](const Effort& /*effort*/, const TellProgress& tell) {
                 tell(0.5, "half of it");
                 return sampleFindings();
             }},
            {"S2", "Nothing", "Is nothing found?", 1, 2,
             [](const Effort& /*effort*/, const TellProgress& /*tell*/) { return Findings{}; }}};
}

}  // namespace hashphase::demos
