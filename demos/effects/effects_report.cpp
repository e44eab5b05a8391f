// SPDX-License-Identifier: Zlib
#include <demos/effects/effects_report.hpp>

#include <demos/console/format.hpp>
#include <demos/console/table.hpp>
#include <demos/report/json_values.hpp>
#include <demos/report/page.hpp>
#include <demos/report/report_text.hpp>

#include <algorithm>
#include <ostream>

namespace hashphase::demos {
namespace {

double perFrame(const EffectsReport& report, std::uint64_t sum) {
    return static_cast<double>(sum) /
           static_cast<double>(std::max<std::size_t>(report.prices.frames, 1));
}

Spread timeOf(const PricedVariant& variant) {
    return spreadOf(variant.frameMs);
}

std::string sceneLine(const EffectsReport& report) {
    const EffectsScene& scene = report.prices.file.scene;
    return report.name + ": " + withThousands(scene.objects) + " bodies, " +
           namesOf(report.prices.file.effects.set());
}

std::string verdictLine(const EffectsReport& report) {
    const Spread whole = timeOf(report.prices.whole());
    return withThousands(report.prices.frames) + " frames: the whole scene " +
           milliseconds(whole.median) + " ms a frame, " +
           byteSize(static_cast<std::int64_t>(totalBytes(report.prices.whole().footprint))) +
           (allHold(report) ? "; what is not declared costs nothing"
                            : "; A CHECK FAILED, see above");
}

// Differences of times that noise can make negative.
std::string price(double ms) {
    return (ms < 0 ? "-" : "") + milliseconds(std::abs(ms));
}

DataTable variantRows(const EffectsReport& report) {
    DataTable table{{{"effects"}, {"frame_ms"}, {"p5_ms"}, {"p95_ms"}, {"bytes"}, {"allocations"}},
                    {}};
    for (const SceneItem& item : sceneCounters()) {
        table.columns.push_back({std::string(item.name)});
    }
    for (const SceneItem& item : sceneTables()) {
        table.columns.push_back({std::string(item.name) + "_bytes"});
    }
    for (const PricedVariant& variant : report.prices.variants) {
        const Spread time = timeOf(variant);
        std::vector<Value> row{namesOf(variant.effects),
                               time.median,
                               time.low,
                               time.high,
                               static_cast<double>(totalBytes(variant.footprint)),
                               variant.allocations ? Value(*variant.allocations) : Value()};
        for (std::size_t i = 0; i < kSceneCounterCount; ++i) {
            row.emplace_back(perFrame(report, variant.cost[static_cast<SceneCounter>(i)]));
        }
        for (std::size_t i = 0; i < kSceneTableCount; ++i) {
            row.emplace_back(static_cast<double>(variant.footprint[static_cast<SceneTable>(i)]));
        }
        table.add(std::move(row));
    }
    return table;
}

DataTable priceRows(const EffectsReport& report) {
    DataTable table{{{"effect", "effect"},
                     {"alone_ms", "alone [ms]"},
                     {"in_all_ms", "within all [ms]"},
                     {"bytes_alone", "bytes alone"},
                     {"bytes_in_all", "bytes within all"},
                     {"work", "a frame"},
                     {"lost", "without it"}},
                    {}};
    for (const EffectPrice& each : report.prices.prices) {
        table.add({std::string(nameOf(each.effect)), each.alone.median, each.inAll.median,
                   static_cast<double>(each.bytesAlone), static_cast<double>(each.bytesInAll),
                   each.work, each.lost});
    }
    return table;
}

/// Both prices of each effect, side by side.
Chart priceChart(const EffectsReport& report, bool ofBytes) {
    Chart chart;
    chart.name = ofBytes ? "effects-bytes" : "effects-time";
    chart.title = ofBytes ? "What each effect takes of memory" : "What each effect costs in time";
    chart.settings =
        sceneLine(report) + "; medians of " + withThousands(report.prices.frames) + " frames";
    chart.mark = ChartMark::kBar;
    chart.data.columns = {{"effect", "effect"},
                          {"price", "price"},
                          {"amount", ofBytes ? "KiB" : "ms a frame"},
                          {"low"},
                          {"high"}};
    constexpr double kibibyte = 1024;
    for (const EffectPrice& each : report.prices.prices) {
        const std::string name(nameOf(each.effect));
        const auto add = [&](const char* which, const Spread& time, std::int64_t bytes) {
            const double amount = static_cast<double>(bytes) / kibibyte;
            chart.data.add({name, std::string(which), ofBytes ? amount : time.median,
                            ofBytes ? amount : time.low, ofBytes ? amount : time.high});
        };
        add("alone", each.alone, each.bytesAlone);
        add("within all", each.inAll, each.bytesInAll);
    }
    chart.x = {"effect", AxisScale::kNames};
    chart.y = {"amount"};
    chart.series = "price";
    if (!ofBytes) {
        chart.low = "low";
        chart.high = "high";
    }
    return chart;
}

Json variantJson(const EffectsReport& report, const PricedVariant& variant) {
    Json json{{"effects", Json::array()},
              {"frameMs", spreadJson(timeOf(variant))},
              {"bytes", totalBytes(variant.footprint)},
              {"allocationsPerFrame", orNull(variant.allocations)},
              {"counters", Json::object()},
              {"tables", Json::object()}};
    for (const Effect effect : kAllEffects) {
        if (variant.effects.contains(effect)) {
            json["effects"].push_back(nameOf(effect));
        }
    }
    for (std::size_t i = 0; i < kSceneCounterCount; ++i) {
        json["counters"][std::string(sceneCounters()[i].name)] =
            perFrame(report, variant.cost[static_cast<SceneCounter>(i)]);
    }
    for (std::size_t i = 0; i < kSceneTableCount; ++i) {
        json["tables"][std::string(sceneTables()[i].name)] =
            variant.footprint[static_cast<SceneTable>(i)];
    }
    return json;
}

constexpr const char* kIntroduction =
    "hashphase is a spatial hash for the Bullet physics engine and for games. A scene declares the "
    "effects that it calls for, and a frame runs just those. This is what each of them costs in "
    "one "
    "scene, and what the scene lacks without it: measured by running the scene with and without "
    "it, "
    "frame by frame in turn.";

}  // namespace

bool allHold(const EffectsReport& report) {
    return std::all_of(report.prices.checks.begin(), report.prices.checks.end(),
                       [](const Check& check) { return check.holds; });
}

void printReport(const EffectsReport& report, std::ostream& out) {
    out << sceneLine(report) << "\n\n";
    Table table({"effect", "alone ms", "in all ms", "bytes alone", "in all"});
    for (const EffectPrice& each : report.prices.prices) {
        table.addRow({std::string(nameOf(each.effect)), price(each.alone.median),
                      price(each.inAll.median), byteSize(each.bytesAlone),
                      byteSize(each.bytesInAll)});
    }
    table.print(out);
    out << "\nalone: with what it needs, less these; in all: the whole scene, less all but it and "
           "what "
           "needs it\n\n";
    for (const EffectPrice& each : report.prices.prices) {
        const std::string name(nameOf(each.effect));
        out << name << std::string(14 - name.size(), ' ') << each.work
            << "\n              without: " << each.lost << '\n';
    }
    out << '\n';
    for (const Check& check : report.prices.checks) {
        out << (check.holds ? "holds   " : "BROKEN  ") << check.claim << " (" << check.evidence
            << ")\n";
    }
    if (report.prices.timeLimitHit) {
        out << "The time limit was reached.\n";
    }
    printProvenance(report.provenance, out);
    out << verdictLine(report) << '\n';
}

void writeJson(const EffectsReport& report, std::ostream& out) {
    Json json{{"schema", "hashphase-effects"},
              {"schemaVersion", 1},
              {"provenance", provenanceJson(report.provenance)},
              {"scene", Json::parse(effectsFileText(report.prices.file))},
              {"frames", report.prices.frames},
              {"timeLimitHit", report.prices.timeLimitHit},
              {"checks", Json::array()},
              {"prices", Json::array()},
              {"variants", Json::array()}};
    for (const Check& check : report.prices.checks) {
        json["checks"].push_back(
            {{"claim", check.claim}, {"holds", check.holds}, {"evidence", check.evidence}});
    }
    for (const EffectPrice& each : report.prices.prices) {
        json["prices"].push_back({{"effect", nameOf(each.effect)},
                                  {"aloneMs", spreadJson(each.alone)},
                                  {"inAllMs", spreadJson(each.inAll)},
                                  {"aloneBytes", each.bytesAlone},
                                  {"inAllBytes", each.bytesInAll},
                                  {"work", each.work},
                                  {"lost", each.lost}});
    }
    for (const PricedVariant& variant : report.prices.variants) {
        json["variants"].push_back(variantJson(report, variant));
    }
    out << textOf(json);
}

void writeCsv(const EffectsReport& report, std::ostream& out) {
    writeCsv(variantRows(report), out);
}

Page pageOf(const EffectsReport& report) {
    PageSection prices;
    prices.heading = "The price list";
    prices.sentences = {
        "Alone: the effect and what it needs, less what it needs. Within all: the whole scene, "
        "less the "
        "scene without the effect and without what needs it. They differ where effects share work: "
        "the grid is filed once for all that ask it."};
    prices.checks = report.prices.checks;
    prices.charts = {priceChart(report, false), priceChart(report, true)};
    prices.tables = {priceRows(report)};
    if (report.prices.timeLimitHit) {
        prices.conclusions = {"The time limit was reached after " +
                              withThousands(report.prices.frames) + " frames."};
    }
    prices.settings = {sceneLine(report) + "."};
    return {"What each effect costs",
            kIntroduction,
            verdictLine(report) + ".",
            report.prices.frames > 0 ? std::optional(allHold(report)) : std::nullopt,
            {prices},
            report.provenance};
}

}  // namespace hashphase::demos
