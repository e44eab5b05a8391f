// SPDX-License-Identifier: Zlib
#include <demos/stability/stability.hpp>

#include <demos/console/format.hpp>
#include <demos/console/progress.hpp>
#include <demos/console/result_file.hpp>
#include <demos/report/report_text.hpp>
#include <demos/report/stopwatch.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/stability/bullet_subject.hpp>
#include <demos/stability/isolation.hpp>
#include <demos/stability/report.hpp>

#include <algorithm>
#include <ostream>

namespace hashphase::demos {
namespace {

// Ours is to end whatever the machine has to do beside it.
constexpr double kPatienceWithOurs = 10;

void printList(std::span<const HardCase* const> cases, std::span<const BroadphaseKind* const> kinds,
               std::ostream& out) {
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

// The items with these names, in their own order; all when none is named.
template <class Item, class NameOf>
std::vector<const Item*> chosenOf(std::string_view whatItIs, const std::vector<std::string>& names,
                                  std::span<const Item> items, const NameOf& nameOf) {
    std::vector<std::string> known;
    for (const Item& each : items) {
        known.emplace_back(nameOf(each));
    }
    for (const std::string& name : names) {
        if (std::find(known.begin(), known.end(), name) == known.end()) {
            throw InputError(unknownNameSentence(whatItIs, name, known));
        }
    }
    std::vector<const Item*> chosen;
    for (const Item& each : items) {
        if (names.empty() || std::find(names.begin(), names.end(), nameOf(each)) != names.end()) {
            chosen.push_back(&each);
        }
    }
    return chosen;
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
        run.add(grid);
    }
    return run.outcome();
}

void runCases(std::span<const HardCase* const> chosen, StabilityReport& report, Console& console) {
    const StabilityOptions& options = report.options;
    Progress progress(console.err, progressStyle(console, options.quiet), "hard cases",
                      chosen.size() * report.kinds.size());
    std::size_t done = 0;
    const Stopwatch sinceBegin;
    for (const HardCase* hardCase : chosen) {
        if (options.timeLimit && sinceBegin.milliseconds() > 1000 * *options.timeLimit) {
            report.leftOut.emplace_back(hardCase->id);
            continue;
        }
        const Stopwatch watch;
        CaseResult result{hardCase, {}, 0};
        for (const BroadphaseKind* kind : report.kinds) {
            const std::string what =
                std::string(hardCase->id) + ": " + hardCase->name + ", " + std::string(kind->name);
            const auto tell = [&] { progress.update(done, what); };
            tell();
            const double seconds = options.caseSeconds * (kind->ours ? kPatienceWithOurs : 1);
            result.outcomes.push_back(
                runIsolated([&] { return runCase(*hardCase, *kind, options); }, {seconds}, tell));
            ++done;
        }
        result.seconds = watch.milliseconds() / 1000;
        report.results.push_back(std::move(result));
    }
}

}  // namespace

std::optional<bool> caseHolds(const StabilityReport& report, const CaseResult& result) {
    std::optional<bool> isHeld;
    for (std::size_t i = 0; i < report.kinds.size(); ++i) {
        if (report.kinds[i]->ours) {
            isHeld = isHeld.value_or(true) && holds(result.outcomes[i]);
        }
    }
    return isHeld;
}

bool allHold(const StabilityReport& report) {
    return std::all_of(report.results.begin(), report.results.end(), [&](const CaseResult& result) {
        return caseHolds(report, result).value_or(true);
    });
}

std::string verdictLine(const StabilityReport& report) {
    const auto count = std::count_if(
        report.results.begin(), report.results.end(),
        [&](const CaseResult& result) { return caseHolds(report, result).value_or(false); });
    const bool isOursAsked = std::any_of(report.kinds.begin(), report.kinds.end(),
                                         [](const BroadphaseKind* kind) { return kind->ours; });
    std::string line = isOursAsked ? std::to_string(count) + " of " +
                                         std::to_string(report.results.size()) + " hard cases hold"
                                   : "ours was not asked";
    std::string others;
    for (std::size_t i = 0; i < report.kinds.size(); ++i) {
        if (report.kinds[i]->ours) {
            continue;
        }
        std::size_t asked = 0;
        std::size_t held = 0;
        for (const CaseResult& result : report.results) {
            if (result.outcomes[i].kind != OutcomeKind::nothing) {
                ++asked;
                held += holds(result.outcomes[i]) ? 1 : 0;
            }
        }
        if (held == asked) {
            continue;
        }
        others += (others.empty() ? "" : ", ") + std::string(report.kinds[i]->name) + " in " +
                  std::to_string(asked - held) + " of " + std::to_string(asked);
    }
    if (!others.empty()) {
        line += "; Bullet's broadphases do not: " + others;
    }
    return line + leftOutText(report.leftOut);
}

int runStability(const StabilityOptions& options, std::span<const BroadphaseKind> kinds,
                 std::span<const HardCase> cases, Console& console) {
    const std::vector<const HardCase*> chosen =
        chosenOf("case", options.only, cases, [](const HardCase& each) { return each.id; });
    StabilityReport report;
    report.options = options;
    report.kinds = chosenOf("broadphase", options.broadphases, kinds,
                            [](const BroadphaseKind& each) { return each.name; });
    if (options.list) {
        printList(chosen, report.kinds, console.out);
        return kExitOk;
    }
    ResultFile json(options.jsonFile);
    ResultFile csv(options.csvFile);
    ResultFile html(options.htmlFile);
    report.provenance = gatherProvenance(console.commandLine);
    const Stopwatch watch;
    runCases(chosen, report, console);
    report.seconds = watch.milliseconds() / 1000;

    printReport(report, console.out);
    json.write([&report](std::ostream& file) { writeJson(report, file); });
    csv.write([&report](std::ostream& file) { writeCsv(report, file); });
    deliverPage(pageOf(report), html, console);
    return allHold(report) ? kExitOk : kExitCheckFailed;
}

}  // namespace hashphase::demos
