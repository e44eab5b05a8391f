// SPDX-License-Identifier: Zlib
#include <demos/paper/paper_report.hpp>

#include <demos/console/format.hpp>
#include <demos/console/table.hpp>
#include <demos/paper/paper_tables.hpp>
#include <demos/report/json_values.hpp>
#include <demos/report/report_text.hpp>

#include <functional>
#include <map>
#include <ostream>

namespace hashphase::demos {
namespace {

constexpr const char* kTiming =
    "Every phase is timed on its own, and hashing all objects anew counts in each of them, on one "
    "thread; drawing counts in none. Triangles are hashed once.";
constexpr const char* kFrames =
    "All methods see the same frames: the bounces and colours that they find are compared, and the "
    "next frame does not depend on them.";
constexpr const char* kMethods =
    "Un-optimized compares everything with everything, and looks for a sphere's triangle until one "
    "has it. The paper's grid is a map of square cells, wiped and filled in every frame, hashed by "
    "multiplication and truncation, its errors corrected: all cells that a box touches, each "
    "pair once.";
constexpr const char* kCamera =
    "Visibility by the paper's grid is that of its free camera: every cell, as high as the domain, "
    "against the frustum; all objects of a cell that is wholly inside, and those that touch of one "
    "that is cut. What the paper timed is its camera from above, between two corners of the "
    "screen, and drawing.";

void printGraded(const GradedTable& table, std::ostream& out) {
    std::vector<std::string> header{table.header[0]};
    header.insert(header.end(), table.header.begin() + 2, table.header.end());
    Table text(header);
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        const std::vector<GradedText>& row = table.rows[i];
        constexpr std::size_t kObjectsWidth = 9;
        const bool isFirst = i == 0 || table.rows[i - 1][0].text != row[0].text;
        std::string first = isFirst ? row[0].text : "";
        first.resize(kObjectsWidth, ' ');
        std::vector<std::string> cells{first + " " + row[1].text};
        for (std::size_t column = 2; column < row.size(); ++column) {
            cells.push_back(row[column].marked());
        }
        text.addRow(std::move(cells));
    }
    out << table.caption << '\n';
    text.print(out);
    out << '\n';
}

void printData(const std::string& caption, const DataTable& data, std::ostream& out) {
    if (data.rows.empty()) {
        return;
    }
    std::vector<std::string> header;
    header.reserve(data.columns.size());
    for (const DataColumn& column : data.columns) {
        header.push_back(titleOf(column));
    }
    Table text(header);
    for (const std::vector<Value>& row : data.rows) {
        std::vector<std::string> cells;
        cells.reserve(row.size());
        for (const Value& value : row) {
            cells.push_back(valueText(value));
        }
        text.addRow(std::move(cells));
    }
    out << caption << '\n';
    text.print(out);
    out << '\n';
}

Json tableJson(const DataTable& table) {
    Json rows = Json::array();
    for (const std::vector<Value>& row : table.rows) {
        Json object;
        for (std::size_t i = 0; i < row.size(); ++i) {
            object[table.columns[i].name] = valueJson(row[i]);
        }
        rows.push_back(std::move(object));
    }
    return rows;
}

Json realTimeJson(const RealTimeTally& tally) {
    Json json;
    for (const Phase phase : kPhases) {
        const auto cells = [](const CellTally& some) {
            return Json{{"paperTooSlow", some.tooSlow},
                        {"paperToday", some.today},
                        {"hashphase", some.hashphase}};
        };
        const auto i = static_cast<std::size_t>(phase);
        json[std::string(nameOf(phase))] = {{"grid", cells(tally.grid[i])},
                                            {"unoptimized", cells(tally.unoptimized[i])}};
    }
    return json;
}

std::string tallyText(std::size_t realTime, std::size_t tooSlow) {
    return std::to_string(realTime) + " of " + std::to_string(tooSlow);
}

/// "6 of 6 of collision with the same cells (the paper's grid on this machine 2)".
std::string tallyText(const CellTally& cells, const std::string& which, const char* rival) {
    return tallyText(cells.hashphase, cells.tooSlow) + " " + which + " (" + rival +
           " on this machine " + std::to_string(cells.today) + ")";
}

/// What in the paper's figures is too slow, and how hashphase fares; empty where nothing is. Of
/// visibility it is no comparison: the paper drew.
std::string realTimeText(const RealTimeTally& tally) {
    constexpr auto kCollision = static_cast<std::size_t>(Phase::collision);
    constexpr auto kAi = static_cast<std::size_t>(Phase::ai);
    constexpr const char* kPaperGrid = "the paper's grid";
    CellTally unoptimized = tally.unoptimized[kCollision];
    unoptimized.tooSlow += tally.unoptimized[kAi].tooSlow;
    unoptimized.today += tally.unoptimized[kAi].today;
    unoptimized.hashphase += tally.unoptimized[kAi].hashphase;
    std::string text;
    const auto add = [&text](const CellTally& cells, const std::string& which, const char* rival) {
        if (cells.tooSlow > 0) {
            text += (text.empty() ? "" : ", ") + tallyText(cells, which, rival);
        }
    };
    add(tally.grid[kCollision], "of collision at the same cell size", kPaperGrid);
    add(tally.grid[kAi], "of AI, by cells that follow the radius", kPaperGrid);
    add(unoptimized, "un-optimized ones of collision and AI, by automatic cells", "un-optimized");
    return text;
}

std::string drawingText(const CellTally& visibility) {
    return "Figure 14 is not counted: the paper's times include drawing, and nothing is drawn "
           "here; "
           "of what is too slow in it, un-optimized on this machine computes " +
           tallyText(visibility.today, visibility.tooSlow) + " in real time, and hashphase " +
           tallyText(visibility.hashphase, visibility.tooSlow);
}

/// " un-optimized 1.2 ms; hashphase, automatic cells 0.1 ms", of a few methods.
std::string timesText(const PhaseResult& result,
                      const std::function<std::vector<double>(const MethodResult&)>& timesOf) {
    std::string text;
    for (const MethodResult& method : result.methods) {
        const bool isShown = method.kind == MethodKind::unoptimized ||
                             method.cellSize == kPrintedCellSizes[1] || !method.cellSize;
        if (isShown && method.isMeasured()) {
            text += (text.empty() ? " " : "; ") + describe(method) + " " +
                    milliseconds(spreadOf(timesOf(method)).median) + " ms";
        }
    }
    return text;
}

/// On which ground how many roam; empty where nothing was measured.
std::string groundsText(const PaperResults& results) {
    std::map<float, const PhaseResult*> most;  // by side
    for (const PhaseResult& result : results.figures) {
        const PhaseResult*& there = most[result.side];
        there = there == nullptr || result.task.objects > there->task.objects ? &result : there;
    }
    most.erase(0);  // what had no time to begin
    std::string text;
    for (const auto& [side, result] : most) {
        const std::string metres = fixed(static_cast<double>(side), 0);
        text += (text.empty() ? "Spheres of radius 1 roam a random terrain: up to " : "; ") +
                withThousands(result->task.objects) + " on " + metres + " x " + metres + " m, of " +
                withThousands(result->triangles) + " triangles";
    }
    return text.empty() ? text : text + ".";
}

}  // namespace

std::string verdictLine(const PaperResults& results) {
    const RealTimeTally tally = tallyRealTime(results);
    const std::string realTime = realTimeText(tally);
    const CellTally& visibility = tally.unoptimized[static_cast<std::size_t>(Phase::visibility)];
    std::string text =
        realTime.empty()
            ? "Of what was measured, the paper has nothing that is too slow for real time"
            : "Of the paper's cells that are too slow for real time, hashphase computes in real "
              "time " +
                  realTime;
    if (visibility.tooSlow > 0) {
        text += ". " + drawingText(visibility);
    }
    const CheckOutcome outcome = results.outcome();
    return text + ". All methods found the same as brute force: " +
           (outcome == CheckOutcome::holds    ? "yes"
            : outcome == CheckOutcome::broken ? "NO, see above"
                                              : "not checked");
}

std::vector<std::string> observations(const PaperResults& results) {
    std::vector<std::string> sentences;
    const std::uint32_t most = results.plan.objects.empty() ? 0 : results.plan.objects.back();
    if (const PhaseResult* visibility = results.figure(Phase::visibility, most)) {
        sentences.push_back(
            "Hashing, which a whole frame does once, counts in each phase. Without "
            "it, visibility of " +
            withThousands(most) + " takes" + timesText(*visibility, &MethodResult::lookMs) + ".");
    }
    if (const PhaseResult* collision = results.figure(Phase::collision, most)) {
        sentences.push_back(
            "Of a collision frame of " + withThousands(most) + ", the ground takes" +
            timesText(*collision, [](const MethodResult& each) { return each.standMs; }) + ".");
    }
    const std::size_t slow = fewFramesTable(results).rows.size();
    if (slow > 0) {
        sentences.push_back(withThousands(slow) + " of the figures' values are of fewer than " +
                            std::to_string(results.plan.effort.frames) +
                            " frames, because they take long; the page and the CSV say which.");
    }
    const LossTally losses = tallyLosses(results);
    if (losses.lost > 0) {
        sentences.push_back("Hashphase loses in " + tallyText(losses.lost, losses.compared) +
                            " cells, where the paper's grid is faster at the same cell size; most "
                            "in " +
                            losses.worst + ", which takes hashphase " +
                            fixed(losses.worstRatio, 1) + " times as long.");
    }
    return sentences;
}

std::vector<std::string> howItWasMeasured(const PaperResults& results) {
    const PaperPlan& plan = results.plan;
    std::vector<std::string> sentences{kTiming, kFrames, kMethods, kCamera};
    if (std::string grounds = groundsText(results); !grounds.empty()) {
        sentences.insert(sentences.begin(), std::move(grounds));
    }
    sentences.push_back("AI counts " + std::to_string(TestBed::kColours) + " colours within " +
                        fixed(static_cast<double>(plan.aiRadius), 1) +
                        " m, from centre to centre; the paper does not give its radius. The cells "
                        "of hashphase's AI follow the radius: a fixed cell size only matters for "
                        "refiling.");
    sentences.push_back(
        "Medians of up to " + withThousands(plan.effort.frames) + " different frames, " +
        (plan.effort.isHurried
             ? "hashphase in a round of its own before the rivals, because the time is limited"
             : "all methods in each, in an order that is drawn anew") +
        "; of what takes longer fewer, but at least " + std::to_string(plan.effort.fewestFrames) +
        ". Seed " + std::to_string(plan.seed) + ".");
    sentences.push_back(
        "In the last frame of a method that un-optimized does not run too, at most " +
        withThousands(kSpotChecked) +
        " objects drawn at random are compared with brute force. Of more than " +
        withThousands(kMostBruteForced) +
        " objects nothing un-optimized is timed, and never more are compared.");
    return sentences;
}

void printReport(const PaperReport& report, bool showMilliseconds, std::ostream& out) {
    const PaperResults& results = report.results;
    out << "The figures of Hastings, Mesit and Guha: as printed (Pentium 4, 3.2 GHz), and on this "
           "machine.\n\"!\" is too slow for real time, below 20 frames a second; \"~\" is below "
           "60.\n\n";
    for (const Phase phase : kPhases) {
        const GradedTable table = figureTable(results, phase, showMilliseconds);
        if (!table.rows.empty()) {
            printGraded(table, out);
        }
    }
    const std::string objects = withThousands(results.plan.sweepObjects);
    printData("AI of " + objects + " by radius", radiusTable(results), out);
    printData("Collision of " + objects + " by cell size", cellSizeTable(results), out);
    printData(withThousands(results.plan.sticks) + " sticks that turn, by bounding volume",
              volumeTable(results), out);
    for (const std::string& sentence : observations(results)) {
        out << sentence << '\n';
    }
    out << '\n';
    for (const std::string& sentence : howItWasMeasured(results)) {
        out << sentence << '\n';
    }
    for (const std::string& each : results.leftOut) {
        out << "Left out for want of time: " << each << '\n';
    }
    out << '\n';
    for (const PaperCheck& check : results.checks) {
        out << nameOf(check.outcome) << ": " << check.claim << " (" << check.evidence << ")\n";
    }
    printProvenance(report.provenance, out);
    out << verdictLine(results) << '\n';
}

void writeJson(const PaperReport& report, std::ostream& out) {
    const PaperResults& results = report.results;
    Json json{{"schema", "hashphase-paper"},
              {"schemaVersion", 1},
              {"provenance", provenanceJson(report.provenance)},
              {"settings",
               {{"objects", results.plan.objects},
                {"seed", results.plan.seed},
                {"aiRadius", results.plan.aiRadius},
                {"frames", results.plan.effort.frames},
                {"fewestFrames", results.plan.effort.fewestFrames}}},
              {"realTime", realTimeJson(tallyRealTime(results))},
              {"leftOut", results.leftOut},
              {"howItWasMeasured", howItWasMeasured(results)},
              {"checks", Json::array()}};
    for (const PaperCheck& check : results.checks) {
        json["checks"].push_back({{"claim", check.claim},
                                  {"holds", orNull(whetherItHolds(check.outcome))},
                                  {"evidence", check.evidence}});
    }
    json["measurements"] = tableJson(measurementRows(results));
    json["neighboursByRadius"] = results.neighbours;
    json["boundingVolumes"] = tableJson(volumeTable(results));
    out << textOf(json);
}

void writeCsv(const PaperReport& report, std::ostream& out) {
    writeCsv(measurementRows(report.results), out);
}

}  // namespace hashphase::demos
