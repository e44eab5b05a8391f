// SPDX-License-Identifier: Zlib
#include <demos/paper/paper_report.hpp>

#include <demos/console/format.hpp>
#include <demos/console/table.hpp>
#include <demos/paper/paper_tables.hpp>
#include <demos/report/json_values.hpp>
#include <demos/report/report_text.hpp>

#include <ostream>

namespace hashphase::demos {
namespace {

constexpr const char* kDomain =
    "Spheres of radius 1 roam a random terrain of 400 x 400 m, of 3,200 triangles; the domain of "
    "more than 50,000 grows so that they stay as dense.";
constexpr const char* kTiming =
    "Every phase is timed on its own, and hashing all objects anew counts in each of them, on one "
    "thread; drawing counts in none. Triangles are hashed once.";
constexpr const char* kFrames =
    "All methods see the same frames: the bounces and colours that they find are compared, and the "
    "next frame does not depend on them.";
constexpr const char* kMethods =
    "Un-optimized compares everything with everything. The paper's grid is a map of square cells, "
    "wiped and filled in every frame, its errors corrected: all cells that a box touches, each "
    "couple once, cells as high as what stands in them.";

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

std::string tallyText(std::size_t realTime, std::size_t tooSlow) {
    return std::to_string(realTime) + " of " + std::to_string(tooSlow);
}

}  // namespace

std::string verdictLine(const PaperResults& results) {
    const RealTimeTally tally = tallyRealTime(results);
    std::string text;
    if (tally.tooSlow + tally.unoptimizedTooSlow > 0) {
        text = "Of the paper's cells that are too slow for real time, hashphase computes " +
               tallyText(tally.realTime, tally.tooSlow) +
               " in real time at the same cell size (the paper's grid on this machine " +
               std::to_string(tally.paperGridRealTime) + "), and " +
               tallyText(tally.unoptimizedRealTime, tally.unoptimizedTooSlow) +
               " of the un-optimized ones; ";
    } else {
        text = "Of what was measured, the paper has nothing that is too slow for real time; ";
    }
    return text + "all methods found the same as brute force: " +
           (results.allHold() ? "yes" : "NO, see above");
}

std::vector<std::string> observations(const PaperResults& results) {
    std::vector<std::string> sentences;
    const PhaseResult* most = results.plan.objects.empty()
                                  ? nullptr
                                  : results.figure(Phase::visibility, results.plan.objects.back());
    if (most != nullptr) {
        std::string sentence =
            "Hashing, which a whole frame does once, counts in each phase. Without it, "
            "visibility of " +
            withThousands(most->task.objects) + " takes";
        for (const MethodResult& method : most->methods) {
            const bool isShown = method.kind == MethodKind::unoptimized ||
                                 method.cellSize == kPrintedCellSizes[1] || !method.cellSize;
            if (isShown && method.isMeasured()) {
                sentence += " " + describe(method) + " " +
                            milliseconds(spreadOf(method.lookMs()).median) + " ms;";
            }
        }
        sentence.back() = '.';
        sentences.push_back(std::move(sentence));
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
    std::vector<std::string> sentences{kDomain, kTiming, kFrames, kMethods};
    sentences.push_back("AI counts " + std::to_string(TestBed::kColours) + " colours within " +
                        fixed(static_cast<double>(plan.aiRadius), 1) +
                        " m, from centre to centre; the paper does not give its radius. The cells "
                        "of hashphase's AI follow the radius: a fixed cell size only matters for "
                        "refiling.");
    sentences.push_back("Medians of up to " + withThousands(plan.effort.frames) +
                        " different frames, all methods in turn in each; of what takes longer "
                        "fewer, but at least " +
                        std::to_string(plan.effort.fewestFrames) + ". Seed " +
                        std::to_string(plan.seed) + ".");
    if (!plan.objects.empty() && plan.objects.back() > kMostBruteForced) {
        sentences.push_back("Of more than " + withThousands(kMostBruteForced) +
                            " objects nothing un-optimized is timed, and the results of " +
                            withThousands(kSubjectsBeyond) +
                            " drawn at random are compared with brute force.");
    }
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
    for (const Check& check : results.checks) {
        out << (check.holds ? "holds   " : "BROKEN  ") << check.claim << " (" << check.evidence
            << ")\n";
    }
    printProvenance(report.provenance, out);
    out << verdictLine(results) << '\n';
}

void writeJson(const PaperReport& report, std::ostream& out) {
    const PaperResults& results = report.results;
    const RealTimeTally tally = tallyRealTime(results);
    Json json{{"schema", "hashphase-paper"},
              {"schemaVersion", 1},
              {"provenance", provenanceJson(report.provenance)},
              {"settings",
               {{"objects", results.plan.objects},
                {"seed", results.plan.seed},
                {"aiRadius", results.plan.aiRadius},
                {"frames", results.plan.effort.frames},
                {"fewestFrames", results.plan.effort.fewestFrames}}},
              {"realTime",
               {{"paperTooSlow", tally.tooSlow},
                {"hashphase", tally.realTime},
                {"paperGridToday", tally.paperGridRealTime},
                {"unoptimizedTooSlow", tally.unoptimizedTooSlow},
                {"hashphaseAutomatic", tally.unoptimizedRealTime}}},
              {"leftOut", results.leftOut},
              {"howItWasMeasured", howItWasMeasured(results)},
              {"checks", Json::array()}};
    for (const Check& check : results.checks) {
        json["checks"].push_back(
            {{"claim", check.claim}, {"holds", check.holds}, {"evidence", check.evidence}});
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
