// SPDX-License-Identifier: Zlib
#include <demos/stability/report.hpp>

#include <demos/console/format.hpp>
#include <demos/report/data_table.hpp>
#include <demos/report/json_values.hpp>
#include <demos/report/page.hpp>
#include <demos/report/report_text.hpp>

#include <array>
#include <ostream>

namespace hashphase::demos {
namespace {

std::string nameOf(OutcomeKind kind) {
    static constexpr std::array<const char*, 8> kNames{"nothing", "exact", "extra", "costly",
                                                       "refuses", "wrong", "hangs", "crashes"};
    return kNames.at(static_cast<std::size_t>(kind));
}

// The longest number that a narrow column shows in full is 99,999.
std::string shortCount(std::uint64_t count) {
    if (count < 100'000) {
        return withThousands(count);
    }
    return count < 10'000'000 ? withThousands(count / 1000) + "k"
                              : withThousands(count / 1'000'000) + "M";
}

std::string ratioText(double ratio) {
    return ' ' + fixed(ratio, ratio < 9.95 ? 1 : 0) + "x";
}

std::string countsText(const CaseOutcome& outcome) {
    std::string text = outcome.missing > 0 ? "-" + shortCount(outcome.missing) : "";
    if (outcome.extra > 0) {
        text += (text.empty() ? "+" : " +") + shortCount(outcome.extra);
    }
    return text;
}

std::string verdictOf(const StabilityReport& report, const CaseResult& result) {
    const std::optional<bool> isHeld = caseHolds(report, result);
    return !isHeld ? "-" : *isHeld ? "holds" : "WRONG";
}

constexpr const char* kLegend =
    "-n: n answers missing; +n: n too many; nx: cost, by what the case measures it with; > n s: "
    "did not end within n s; -: nothing to ask it for";

// A row for each case: what each broadphase does, and the verdict.
DataTable tableOf(const StabilityReport& report) {
    DataTable table{{{"id", "id"}, {"case", "case"}}, {}};
    for (const BroadphaseKind* kind : report.kinds) {
        table.columns.push_back({std::string(kind->name), std::string(kind->name)});
    }
    table.columns.push_back({"verdict", "verdict"});
    for (const CaseResult& result : report.results) {
        std::vector<Value> row{result.hardCase->id, result.hardCase->name};
        for (const CaseOutcome& outcome : result.outcomes) {
            row.emplace_back(outcomeText(outcome));
        }
        row.emplace_back(verdictOf(report, result));
        table.add(std::move(row));
    }
    return table;
}

// --- Text -----------------------------------------------------------------------------------------

void printWords(DataTable table, std::ostream& out) {
    table.columns[table.columnOf("id")].title = " ";
    printTable(table, out, true);
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

DataTable rowsOf(const StabilityReport& report) {
    DataTable table;
    for (const char* name : {"case", "name", "broadphase", "outcome", "text", "holds", "compared",
                             "missing", "extra", "cost_ratio", "note"}) {
        table.columns.push_back({name});
    }
    for (const CaseResult& result : report.results) {
        for (std::size_t i = 0; i < report.kinds.size(); ++i) {
            const CaseOutcome& outcome = result.outcomes[i];
            table.add({result.hardCase->id, result.hardCase->name,
                       std::string(report.kinds[i]->name), nameOf(outcome.kind),
                       outcomeText(outcome), holds(outcome) ? 1.0 : 0.0,
                       static_cast<double>(outcome.compared), static_cast<double>(outcome.missing),
                       static_cast<double>(outcome.extra),
                       outcome.costRatio ? Value(*outcome.costRatio) : Value(), outcome.note});
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
    "are inputs on which plain code goes wrong: numbers that are none, borders of cells, rays "
    "without end, crowds, speeds, changes at the wrong moment. Each was run with every broadphase, "
    "in a process of its own, and what it answered was compared with what looking at everything "
    "says.";

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

std::string outcomeText(const CaseOutcome& outcome) {
    switch (outcome.kind) {
        case OutcomeKind::nothing:
            return "-";
        case OutcomeKind::exact:
            return "exact" + (outcome.costRatio ? ratioText(*outcome.costRatio) : "");
        case OutcomeKind::costly:
            return "costly" + ratioText(outcome.costRatio.value_or(0));
        case OutcomeKind::extra:
            return countsText(outcome);
        case OutcomeKind::wrong:
            return outcome.missing > 0 ? countsText(outcome) : "wrong";
        case OutcomeKind::hangs:
            return "> " + fixed(outcome.seconds, outcome.seconds < 1 ? 2 : 0) + " s";
        default:
            return nameOf(outcome.kind);
    }
}

void printReport(const StabilityReport& report, std::ostream& out) {
    printWords(tableOf(report), out);
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
    PageSection table;
    table.heading = "What each one does";
    table.sentences = {std::string(kLegend) + "."};
    table.tables = {tableOf(report)};
    Page page{"Hard cases", kIntroduction, verdictLine(report) + ".",
              std::nullopt, {table},       report.provenance};
    for (const CaseResult& result : report.results) {
        if (caseHolds(report, result)) {
            page.holds = allHold(report);
        }
        page.sections.push_back(caseSection(report, result));
    }
    return page;
}

}  // namespace hashphase::demos
