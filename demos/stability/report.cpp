// SPDX-License-Identifier: Zlib
#include <demos/stability/report.hpp>

#include <demos/console/format.hpp>
#include <demos/report/data_table.hpp>
#include <demos/report/json_values.hpp>
#include <demos/report/page.hpp>
#include <demos/report/report_text.hpp>

#include <algorithm>
#include <ostream>

namespace hashphase::demos {
namespace {

std::string verdictOf(const StabilityReport& report, const CaseResult& result) {
    const std::optional<bool> isHeld = caseHolds(report, result);
    return !isHeld ? "-" : *isHeld ? "holds" : "WRONG";
}

constexpr const char* kLegend =
    "-n: n answers missing; +n: n too many; nx: cost, by what the case measures it with; > n s: "
    "did "
    "not end within n s; -: nothing to ask it for";

// --- Text -----------------------------------------------------------------------------------------

// Columns stand to the left, as words do.
void printColumns(const std::vector<std::vector<std::string>>& rows, std::ostream& out) {
    std::vector<std::size_t> widths(rows.front().size(), 0);
    for (const std::vector<std::string>& row : rows) {
        for (std::size_t i = 0; i < row.size(); ++i) {
            widths[i] = std::max(widths[i], row[i].size());
        }
    }
    for (const std::vector<std::string>& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i) {
            line += row[i] + std::string(widths[i] + 2 - row[i].size(), ' ');
        }
        line.erase(line.find_last_not_of(' ') + 1);
        out << line << '\n';
        if (&row == &rows.front()) {
            std::size_t width = 0;
            for (const std::size_t each : widths) {
                width += each + 2;
            }
            out << std::string(width - 2, '-') << '\n';
        }
    }
}

void printTable(const StabilityReport& report, std::ostream& out) {
    std::vector<std::vector<std::string>> rows;
    std::vector<std::string> header{"", "case"};
    for (const BroadphaseKind* kind : report.kinds) {
        header.emplace_back(kind->name);
    }
    header.emplace_back("verdict");
    rows.push_back(std::move(header));
    for (const CaseResult& result : report.results) {
        std::vector<std::string> row{result.hardCase->id, result.hardCase->name};
        for (const CaseOutcome& outcome : result.outcomes) {
            row.push_back(outcomeText(outcome));
        }
        row.push_back(verdictOf(report, result));
        rows.push_back(std::move(row));
    }
    printColumns(rows, out);
}

std::string detailOf(const CaseOutcome& outcome) {
    std::string text = outcomeText(outcome);
    if (outcome.compared > 0) {
        text += " (" + withThousands(outcome.compared) + " answers looked for)";
    }
    if (!outcome.note.empty()) {
        text += ". " + outcome.note;
    }
    return text;
}

void explain(const StabilityReport& report, const CaseResult& result, std::ostream& out) {
    const HardCase& hardCase = *result.hardCase;
    out << '\n'
        << hardCase.id << ' ' << hardCase.name << ": " << verdictOf(report, result) << ", "
        << fixed(result.seconds, 1) << " s\n  input: " << hardCase.input
        << "\n  required: " << hardCase.required << '\n';
    for (std::size_t i = 0; i < report.kinds.size(); ++i) {
        out << "  " << report.kinds[i]->name << ": " << detailOf(result.outcomes[i]) << '\n';
    }
}

// --- Data -----------------------------------------------------------------------------------------

Value numberOrNothing(const std::optional<double>& number) {
    return number ? Value(*number) : Value();
}

DataTable rowsOf(const StabilityReport& report) {
    DataTable table{{{"case"},
                     {"name"},
                     {"broadphase"},
                     {"outcome"},
                     {"text"},
                     {"holds"},
                     {"compared"},
                     {"missing"},
                     {"extra"},
                     {"cost_ratio"},
                     {"note"}},
                    {}};
    for (const CaseResult& result : report.results) {
        for (std::size_t i = 0; i < report.kinds.size(); ++i) {
            const CaseOutcome& outcome = result.outcomes[i];
            table.add({std::string(result.hardCase->id), std::string(result.hardCase->name),
                       std::string(report.kinds[i]->name), std::string(nameOf(outcome.kind)),
                       outcomeText(outcome), holds(outcome) ? 1.0 : 0.0,
                       static_cast<double>(outcome.compared), static_cast<double>(outcome.missing),
                       static_cast<double>(outcome.extra), numberOrNothing(outcome.costRatio),
                       outcome.note});
        }
    }
    return table;
}

Json outcomesJson(const StabilityReport& report, const CaseResult& result) {
    Json outcomes = Json::array();
    for (std::size_t i = 0; i < report.kinds.size(); ++i) {
        const CaseOutcome& outcome = result.outcomes[i];
        outcomes.push_back({{"broadphase", report.kinds[i]->name},
                            {"ours", report.kinds[i]->ours},
                            {"outcome", nameOf(outcome.kind)},
                            {"text", outcomeText(outcome)},
                            {"holds", holds(outcome)},
                            {"compared", outcome.compared},
                            {"missing", outcome.missing},
                            {"extra", outcome.extra},
                            {"costRatio", orNull(outcome.costRatio)},
                            {"note", orNull(outcome.note)}});
    }
    return outcomes;
}

// --- Page -----------------------------------------------------------------------------------------

constexpr const char* kIntroduction =
    "hashphase is a spatial hash that replaces the broadphase of the Bullet physics engine. These "
    "are "
    "inputs on which plain code goes wrong: numbers that are none, borders of cells, rays without "
    "end, "
    "crowds, speeds, changes at the wrong moment. Each was run with every broadphase, in a process "
    "of "
    "its own, and what it answered was compared with what looking at everything says.";

PageSection tableSection(const StabilityReport& report) {
    PageSection section;
    section.heading = "What each one does";
    section.sentences = {std::string(kLegend) + "."};
    DataTable table{{{"id", "id"}, {"case", "case"}}, {}};
    for (const BroadphaseKind* kind : report.kinds) {
        table.columns.push_back({std::string(kind->name), std::string(kind->name)});
    }
    table.columns.push_back({"verdict", "verdict"});
    for (const CaseResult& result : report.results) {
        std::vector<Value> row{std::string(result.hardCase->id),
                               std::string(result.hardCase->name)};
        for (const CaseOutcome& outcome : result.outcomes) {
            row.emplace_back(outcomeText(outcome));
        }
        row.emplace_back(verdictOf(report, result));
        table.add(std::move(row));
    }
    section.tables = {table};
    return section;
}

PageSection caseSection(const StabilityReport& report, const CaseResult& result) {
    const HardCase& hardCase = *result.hardCase;
    PageSection section;
    section.heading = std::string(hardCase.id) + " " + hardCase.name;
    section.sentences = {"Input: " + std::string(hardCase.input) + "."};
    std::string ours;
    for (std::size_t i = 0; i < report.kinds.size(); ++i) {
        const std::string told =
            std::string(report.kinds[i]->name) + ": " + detailOf(result.outcomes[i]);
        if (report.kinds[i]->ours) {
            ours += (ours.empty() ? "" : "; ") + told;
        } else {
            section.conclusions.push_back(told);
        }
    }
    if (const std::optional<bool> isHeld = caseHolds(report, result)) {
        section.checks = {{hardCase.required, *isHeld, ours}};
    } else {
        section.sentences.push_back("Required: " + std::string(hardCase.required) + ".");
    }
    return section;
}

}  // namespace

void printReport(const StabilityReport& report, std::ostream& out) {
    printTable(report, out);
    out << kLegend << '\n';
    for (const CaseResult& result : report.results) {
        if (report.options.isExplained || !caseHolds(report, result).value_or(true)) {
            explain(report, result, out);
        }
    }
    out << '\n';
    printProvenance(report.provenance, out);
    out << verdictLine(report) << '\n';
}

void writeJson(const StabilityReport& report, std::ostream& out) {
    Json json{{"schema", "hashphase-stability"},
              {"schemaVersion", 1},
              {"provenance", provenanceJson(report.provenance)},
              {"settings",
               {{"quick", report.options.isQuick},
                {"seed", report.options.seed},
                {"caseTimeLimitSeconds", report.options.caseSeconds}}},
              {"verdict", {{"text", verdictLine(report)}, {"holds", allHold(report)}}},
              {"seconds", report.seconds},
              {"leftOut", report.leftOut},
              {"cases", Json::array()}};
    for (const CaseResult& result : report.results) {
        json["cases"].push_back({{"id", result.hardCase->id},
                                 {"name", result.hardCase->name},
                                 {"input", result.hardCase->input},
                                 {"required", result.hardCase->required},
                                 {"holds", orNull(caseHolds(report, result))},
                                 {"seconds", result.seconds},
                                 {"outcomes", outcomesJson(report, result)}});
    }
    out << textOf(json);
}

void writeCsv(const StabilityReport& report, std::ostream& out) {
    writeCsv(rowsOf(report), out);
}

Page pageOf(const StabilityReport& report) {
    Page page{"Hard cases", kIntroduction,          verdictLine(report) + ".",
              std::nullopt, {tableSection(report)}, report.provenance};
    for (const CaseResult& result : report.results) {
        if (caseHolds(report, result)) {
            page.holds = allHold(report);
        }
        page.sections.push_back(caseSection(report, result));
    }
    return page;
}

}  // namespace hashphase::demos
