// SPDX-License-Identifier: Zlib
#include <demos/effects/effects_report.hpp>

#include <demos/console/format.hpp>
#include <demos/report/json_values.hpp>
#include <demos/report/page.hpp>
#include <demos/report/report_text.hpp>

#include <algorithm>
#include <ostream>

namespace hashphase::demos {
namespace {

Spread timeOf(const PricedVariant& variant) {
    return spreadOf(variant.frameMs);
}

std::string sceneLine(const EffectPrices& prices) {
    const EffectsScene& scene = prices.file.scene;
    return prices.name + ": " + withThousands(scene.objects) + " bodies, " +
           namesOf(prices.file.effects.set());
}

std::string verdictLine(const EffectPrices& prices) {
    const Spread whole = timeOf(prices.whole());
    return withThousands(prices.frames) + " frames: the whole scene " + milliseconds(whole.median) +
           " ms a frame, " +
           byteSize(static_cast<std::int64_t>(totalBytes(prices.whole().footprint))) +
           (allHold(prices) ? "; what is not declared costs nothing"
                            : "; A CHECK FAILED, see above");
}

// Differences of times that noise can make negative.
std::string priceText(double ms) {
    return (ms < 0 ? "-" : "") + milliseconds(std::abs(ms));
}

DataTable variantRows(const EffectPrices& prices) {
    DataTable table{{{"effects"}, {"frame_ms"}, {"p5_ms"}, {"p95_ms"}, {"bytes"}, {"allocations"}},
                    {}};
    for (const SceneItem& item : sceneCounters()) {
        table.columns.push_back({std::string(item.name)});
    }
    for (const SceneItem& item : sceneTables()) {
        table.columns.push_back({std::string(item.name) + "_bytes"});
    }
    for (const PricedVariant& variant : prices.variants) {
        const Spread time = timeOf(variant);
        std::vector<Value> row{namesOf(variant.effects),
                               time.median,
                               time.low,
                               time.high,
                               static_cast<double>(totalBytes(variant.footprint)),
                               variant.allocations ? Value(*variant.allocations) : Value()};
        for (std::size_t i = 0; i < kSceneCounterCount; ++i) {
            row.emplace_back(prices.perFrame(variant, static_cast<SceneCounter>(i)));
        }
        for (std::size_t i = 0; i < kSceneTableCount; ++i) {
            row.emplace_back(static_cast<double>(variant.footprint[static_cast<SceneTable>(i)]));
        }
        table.add(std::move(row));
    }
    return table;
}

DataTable priceRows(const EffectPrices& prices) {
    DataTable table{{{"effect", "effect"},
                     {"alone_ms", "alone [ms]"},
                     {"in_all_ms", "within all [ms]"},
                     {"bytes_alone", "bytes alone"},
                     {"bytes_in_all", "bytes within all"},
                     {"work", "a frame"},
                     {"lost", "without it"}},
                    {}};
    for (const EffectPrice& each : prices.prices) {
        table.add({std::string(nameOf(each.effect)), each.alone.time.median, each.inAll.time.median,
                   static_cast<double>(each.alone.bytes), static_cast<double>(each.inAll.bytes),
                   each.work, each.lost});
    }
    return table;
}

/// Both prices of each effect, side by side.
Chart priceChart(const EffectPrices& prices, bool ofBytes) {
    Chart chart;
    chart.name = ofBytes ? "effects-bytes" : "effects-time";
    chart.title = ofBytes ? "What each effect takes of memory" : "What each effect costs in time";
    chart.settings = sceneLine(prices) + "; medians of " + withThousands(prices.frames) + " frames";
    chart.mark = ChartMark::kBar;
    chart.data.columns = {{"effect", "effect"},
                          {"price", "price"},
                          {"amount", ofBytes ? "KiB" : "ms a frame"},
                          {"low"},
                          {"high"}};
    constexpr double kibibyte = 1024;
    for (const EffectPrice& each : prices.prices) {
        for (const auto& [which, price] :
             {std::pair("alone", each.alone), std::pair("within all", each.inAll)}) {
            const double amount = static_cast<double>(price.bytes) / kibibyte;
            const Spread shown = ofBytes ? Spread{amount, amount, amount} : price.time;
            chart.data.add({std::string(nameOf(each.effect)), std::string(which), shown.median,
                            shown.low, shown.high});
        }
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

Json variantJson(const EffectPrices& prices, const PricedVariant& variant) {
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
            prices.perFrame(variant, static_cast<SceneCounter>(i));
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
    "one scene, and what the scene lacks without it: measured by running the scene with and "
    "without it, frame by frame in turn.";

}  // namespace

bool allHold(const EffectPrices& prices) {
    return std::ranges::all_of(prices.checks, &Check::holds);
}

void printReport(const EffectPrices& prices, std::ostream& out) {
    out << sceneLine(prices) << "\n\n";
    DataTable table{{{"effect"}, {"alone ms"}, {"in all ms"}, {"bytes alone"}, {"in all"}}, {}};
    for (const EffectPrice& each : prices.prices) {
        table.add({std::string(nameOf(each.effect)), priceText(each.alone.time.median),
                   priceText(each.inAll.time.median), byteSize(each.alone.bytes),
                   byteSize(each.inAll.bytes)});
    }
    printTable(table, out);
    out << "\nalone: with what it needs, less these; in all: the whole scene, less all but it and "
           "what needs it\n\n";
    for (const EffectPrice& each : prices.prices) {
        const std::string name(nameOf(each.effect));
        out << name << std::string(14 - name.size(), ' ') << each.work
            << "\n              without: " << each.lost << '\n';
    }
    out << '\n';
    for (const Check& check : prices.checks) {
        out << (check.holds ? "holds   " : "BROKEN  ") << check.claim << " (" << check.evidence
            << ")\n";
    }
    if (prices.timeLimitHit) {
        out << "The time limit was reached.\n";
    }
    printProvenance(prices.provenance, out);
    out << verdictLine(prices) << '\n';
}

void writeJson(const EffectPrices& prices, std::ostream& out) {
    Json json{{"schema", "hashphase-effects"},
              {"schemaVersion", 1},
              {"provenance", provenanceJson(prices.provenance)},
              {"scene", Json::parse(effectsFileText(prices.file))},
              {"frames", prices.frames},
              {"timeLimitHit", prices.timeLimitHit},
              {"checks", Json::array()},
              {"prices", Json::array()},
              {"variants", Json::array()}};
    for (const Check& check : prices.checks) {
        json["checks"].push_back(
            {{"claim", check.claim}, {"holds", check.holds}, {"evidence", check.evidence}});
    }
    for (const EffectPrice& each : prices.prices) {
        json["prices"].push_back({{"effect", nameOf(each.effect)},
                                  {"aloneMs", spreadJson(each.alone.time)},
                                  {"inAllMs", spreadJson(each.inAll.time)},
                                  {"aloneBytes", each.alone.bytes},
                                  {"inAllBytes", each.inAll.bytes},
                                  {"work", each.work},
                                  {"lost", each.lost}});
    }
    for (const PricedVariant& variant : prices.variants) {
        json["variants"].push_back(variantJson(prices, variant));
    }
    out << textOf(json);
}

void writeCsv(const EffectPrices& prices, std::ostream& out) {
    writeCsv(variantRows(prices), out);
}

Page pageOf(const EffectPrices& prices) {
    PageSection list;
    list.heading = "The price list";
    list.sentences = {
        "Alone: the effect and what it needs, less what it needs. Within all: the whole scene, "
        "less the scene without the effect and without what needs it. They differ where effects "
        "share work: the grid is filed once for all that ask it."};
    list.checks = prices.checks;
    list.charts = {priceChart(prices, false), priceChart(prices, true)};
    list.tables = {priceRows(prices)};
    if (prices.timeLimitHit) {
        list.conclusions = {"The time limit was reached after " + withThousands(prices.frames) +
                            " frames."};
    }
    list.settings = {sceneLine(prices) + "."};
    return {"What each effect costs",
            kIntroduction,
            verdictLine(prices) + ".",
            prices.frames > 0 ? std::optional(allHold(prices)) : std::nullopt,
            {list},
            prices.provenance};
}

}  // namespace hashphase::demos
