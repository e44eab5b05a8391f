// SPDX-License-Identifier: Zlib
#include <demos/stability/stability_command.hpp>

#include <demos/console/columns.hpp>
#include <demos/console/format.hpp>
#include <demos/console/options.hpp>
#include <demos/console/progress.hpp>
#include <demos/console/result_file.hpp>
#include <demos/experiment/findings.hpp>
#include <demos/report/json_values.hpp>
#include <demos/report/report_text.hpp>
#include <demos/report/time_limit.hpp>
#include <demos/stability/bullet_subject.hpp>
#include <demos/stability/isolation.hpp>
#include <demos/system/other_programs.hpp>

#include <CLI/CLI.hpp>

#include <array>
#include <ostream>

namespace hashphase::demos {
namespace {

constexpr std::string_view kStabilityDeclaration =
#include <demos/stability/stability.sql>
    ;

constexpr const char* kStabilityIntroduction =
    "hashphase is a spatial hash that replaces the broadphase of the Bullet physics engine. This "
    "page shows hard cases, on which simple code fails: NaN, cell borders, very long rays, crowds, "
    "high speeds, changes during a query. Each case ran with every broadphase, in a separate "
    "process. Brute force checked the answers.";

// Ours is to end whatever the machine has to do beside it.
constexpr double kPatienceWithOurs = 10;

struct StabilityOptions {
    std::vector<std::string> only;         // ids; empty: all
    std::vector<std::string> broadphases;  // names; empty: all
    bool isQuick = false;
    bool isExplained = false;
    std::uint64_t seed = 1;
    double caseSeconds = 2;           // of processor time for a case; ours has ten times that
    std::optional<double> timeLimit;  // [s] of wall time, after which no case begins
    std::string jsonFile;             // empty: none is written
    std::string csvFile;
    std::string htmlFile;
    bool quiet = false;
    bool list = false;
};

using Cases = std::vector<const HardCase*>;
using Kinds = std::vector<const BroadphaseKind*>;

void declareStability(CLI::App& app, StabilityOptions& options) {
    app.add_option("--only", options.only,
                   "run only these cases, separated by commas; --list prints all")
        ->type_name("ID")
        ->delimiter(',');
    app.add_option("--broadphases", options.broadphases,
                   "run only these broadphases, separated by commas; --list prints all")
        ->type_name("NAME")
        ->delimiter(',');
    app.add_flag("--quick", options.isQuick, "use smaller inputs: some seconds for all cases");
    app.add_flag("--explain", options.isExplained,
                 "print the input, the requirement and the outcomes of each case");
    app.add_option("--seed", options.seed, "seed of all random numbers")
        ->transform(seedUpTo())
        ->capture_default_str();
    app.add_option("--case-time-limit", options.caseSeconds,
                   "seconds of processor time that a broadphase gets for each case; hashphase gets "
                   "ten times this limit, so that it does not fail on a slow machine")
        ->transform(positiveSeconds())
        ->capture_default_str();
    app.add_option("--time-limit", options.timeLimit, "start no case after this many seconds")
        ->transform(positiveSeconds());
    addFileToWrite(app, "--json", options.jsonFile, "write all results to this file");
    addFileToWrite(app, "--csv", options.csvFile,
                   "write a row per case and broadphase to this file");
    addFileToWrite(app, "--html", options.htmlFile, "write a page with the table to this file");
    app.add_flag("--quiet", options.quiet, "print no progress");
    app.add_flag("--list", options.list, "print the cases and broadphases, and exit");
}

void printList(const Cases& cases, const Kinds& kinds, std::ostream& out) {
    const auto print = [&](const std::string& name, std::string_view about, std::size_t width) {
        out << "  " << name << std::string(width - name.size(), ' ') << about << '\n';
    };
    out << "Hard cases:\n";
    for (const HardCase* each : cases) {
        print(each->id, each->name, 5);
    }
    out << "Broadphases:\n";
    for (const BroadphaseKind* each : kinds) {
        print(std::string(each->name), each->description, 15);
    }
}

// --- What is measured -----------------------------------------------------------------------------

// The longest number that a narrow column shows in full is 99,999.
std::string shortCount(std::uint64_t count) {
    if (count < 100'000) {
        return withThousands(count);
    }
    return count < 10'000'000 ? withThousands(count / 1000) + "k"
                              : withThousands(count / 1'000'000) + "M";
}

std::string costText(double ratio) {
    return ratio < 0.05 ? " <0.1x" : ' ' + fixed(ratio, ratio < 9.95 ? 1 : 0) + "x";
}

std::string countsText(const CaseOutcome& outcome) {
    std::string text = outcome.missing > 0 ? "-" + shortCount(outcome.missing) : "";
    if (outcome.extra > 0) {
        text += (text.empty() ? "+" : " +") + shortCount(outcome.extra);
    }
    return text;
}

std::string nameOf(OutcomeKind kind) {
    static constexpr std::array<const char*, 8> kNames{"nothing", "exact", "extra", "costly",
                                                       "refuses", "wrong", "hangs", "crashes"};
    return kNames.at(static_cast<std::size_t>(kind));
}

// Of ours by Bullet's interface, and, on smaller inputs, of the grid alone in double precision.
CaseOutcome runCase(const HardCase& hardCase, const BroadphaseKind& kind,
                    const StabilityOptions& options) {
    CaseRun<float> run;
    run.make = [&kind](const SubjectNeeds<float>& needs) {
        return std::make_unique<BulletSubject>(kind.make({needs.world, needs.objects, needs.grid}),
                                               needs.objects, kind.freesProxies);
    };
    run.name = kind.name;
    run.isOurs = kind.ours;
    run.isQuick = options.isQuick;
    run.seed = options.seed;
    hardCase.inSingle(run);
    if (kind.name == broadphaseKinds()[0].name && hardCase.inDouble != nullptr) {
        CaseRun<double> grid;
        grid.isQuick = true;
        grid.seed = options.seed;
        hardCase.inDouble(grid);
        run.add(grid, " (Grid<double> without Bullet)");
    }
    return run.outcome();
}

/// As rows that stability.sql names.
Measurements runCases(const Cases& cases, const Kinds& kinds, const StabilityOptions& options,
                      Console& console) {
    Measurements measured;
    measured.create("cases", {"id", "name", "input", "required", "seconds"});
    measured.create("outcomes", {"id", "broadphase", "outcome", "text", "holds", "compared",
                                 "missing", "extra", "cost_ratio", "note"});
    for (const BroadphaseKind* kind : kinds) {
        measured.add("kinds", {{"broadphase", kind->name}, {"ours", kind->ours}});
    }
    Progress progress(console.err, progressStyle(console, options.quiet), "hard cases",
                      cases.size() * kinds.size());
    std::size_t done = 0;
    std::vector<std::string> leftOut;
    const Stopwatch sinceBegin;
    const TimeLimit limit(options.timeLimit);
    for (const HardCase* each : cases) {
        if (limit.isOver()) {
            leftOut.emplace_back(each->id);
            continue;
        }
        const Stopwatch watch;
        std::vector<Record> outcomes;
        for (const BroadphaseKind* kind : kinds) {
            if (isInterrupted()) {
                break;
            }
            const std::string what =
                std::string(each->id) + ": " + each->name + ", " + std::string(kind->name);
            const auto tell = [&] { progress.update(done, what); };
            tell();
            const double seconds = options.caseSeconds * (kind->ours ? kPatienceWithOurs : 1);
            const CaseOutcome outcome =
                runIsolated([&] { return runCase(*each, *kind, options); }, {seconds}, tell);
            outcomes.push_back({{"id", each->id},
                                {"broadphase", kind->name},
                                {"outcome", nameOf(outcome.kind)},
                                {"text", outcomeText(outcome)},
                                {"holds", holds(outcome)},
                                {"compared", outcome.compared},
                                {"missing", outcome.missing},
                                {"extra", outcome.extra},
                                {"cost_ratio", outcome.costRatio},
                                {"note", outcome.note}});
            ++done;
        }
        if (isInterrupted()) {
            leftOut.emplace_back(each->id);
            continue;
        }
        for (const Record& outcome : outcomes) {
            measured.add("outcomes", outcome);
        }
        measured.add("cases", {{"id", each->id},
                               {"name", each->name},
                               {"input", each->input},
                               {"required", each->required},
                               {"seconds", watch.milliseconds() / 1000}});
    }
    measured.create("left_out", {"id"});
    for (const std::string& id : leftOut) {
        measured.add("left_out", {{"id", id}});
    }
    measured.add("run", {{"is_explained", options.isExplained},
                         {"left_out_text", leftOutText(leftOut)},
                         {"all_seconds", sinceBegin.milliseconds() / 1000}});
    return measured;
}

// --- What is told ---------------------------------------------------------------------------------

/// A row for each case; all about each case where that was asked for; what is not as required; the
/// verdict.
void printReport(const Findings& findings, const Provenance& provenance, const Console& console) {
    const auto& [legend, table] = findings.printed.front();
    if (!table.rows.empty()) {
        printTable(table, console.out, {.columns = lineWidth(console), .isOfWords = true});
        printSentences({legend}, console);
    }
    printSentences(sentencesOf(findings.rows.at("explained")), console);
    console.out << '\n';
    printProvenance(provenance, console);
    printVerdict(findings.verdict, console);
}

/// Schema "hashphase-stability".
void writeJson(const Findings& findings, const Provenance& provenance,
               const StabilityOptions& options, Measurements& measured, std::ostream& out) {
    Json cases = rowsJson(findings.rows.at("cases"));
    for (Json& each : cases) {
        each["outcomes"] = Json::array();
    }
    auto of = cases.begin();
    for (Json& outcome : rowsJson(findings.rows.at("outcomes"))) {
        of += (*of)["id"] == outcome["id"] ? 0 : 1;
        outcome.erase("id");
        (*of)["outcomes"].push_back(std::move(outcome));
    }
    Json json{{"schema", "hashphase-stability"},
              {"schemaVersion", 1},
              {"provenance", provenanceJson(provenance)},
              {"settings",
               {{"quick", options.isQuick},
                {"seed", options.seed},
                {"caseTimeLimitSeconds", options.caseSeconds}}}};
    json.update(rowsJson(findings.rows.at("end")).front());
    json["seconds"] = valueJson(measured.ask("SELECT all_seconds FROM run").rows.at(0).at(0));
    json["interrupted"] = isInterrupted();
    json["leftOut"] = sentencesOf(measured.ask("SELECT id FROM left_out"));
    json["cases"] = std::move(cases);
    out << textOf(json);
}

int runStability(const StabilityOptions& options, std::span<const BroadphaseKind> allKinds,
                 std::span<const HardCase> allCases, Console& console) {
    const Cases cases =
        chosenOf("case", options.only, allCases, [](const HardCase& each) { return each.id; });
    const Kinds kinds = chosenOf("broadphase", options.broadphases, allKinds,
                                 [](const BroadphaseKind& each) { return each.name; });
    if (options.list) {
        printList(cases, kinds, console.out);
        return kExitOk;
    }
    ResultFile json(options.jsonFile);
    ResultFile csv(options.csvFile);
    ResultFile html(options.htmlFile);
    Provenance provenance = gatherProvenance(console.commandLine);
    const OtherPrograms others;
    Measurements measured = runCases(cases, kinds, options, console);
    provenance.coresOfOthers = others.cores();
    const Findings findings = findingsOf(kStabilityDeclaration, measured);

    printReport(findings, provenance, console);
    ResultFaults faults;
    faults.collect([&] {
        json.write(
            [&](std::ostream& file) { writeJson(findings, provenance, options, measured, file); });
    });
    faults.collect(
        [&] { csv.write([&](std::ostream& file) { writeCsv(findings.rows.at("csv"), file); }); });
    faults.collect([&] {
        deliverPage({"Hard cases", kStabilityIntroduction, findings.verdict + ".", findings.holds,
                     findings.sections, provenance},
                    html, console);
    });
    faults.throwIfAny();
    return findings.holds.value_or(true) ? kExitOk : kExitCheckFailed;
}

}  // namespace

std::string outcomeText(const CaseOutcome& outcome) {
    switch (outcome.kind) {
        case OutcomeKind::nothing:
            return "-";
        case OutcomeKind::exact:
            return "exact" + (outcome.costRatio ? costText(*outcome.costRatio) : "");
        case OutcomeKind::costly:
            return "costly" + costText(outcome.costRatio.value_or(0));
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

Subcommand stabilityCommand(std::span<const BroadphaseKind> kinds,
                            std::span<const HardCase> cases) {
    return makeSubcommand<StabilityOptions>("stability", declareStability,
                                            [kinds, cases](const auto& options, Console& console) {
                                                return runStability(options, kinds, cases, console);
                                            });
}

}  // namespace hashphase::demos
