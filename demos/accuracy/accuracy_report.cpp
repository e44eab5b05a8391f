// SPDX-License-Identifier: Zlib
#include <demos/accuracy/accuracy_report.hpp>

#include <demos/console/columns.hpp>
#include <demos/console/format.hpp>
#include <demos/console/result_file.hpp>
#include <demos/report/json_values.hpp>
#include <demos/report/report_text.hpp>

#include <algorithm>
#include <array>
#include <ostream>

namespace hashphase::demos {
namespace {

constexpr const char* kIntroduction =
    "hashphase is a spatial hash that replaces the broadphase of the Bullet physics engine. A "
    "program that may be a little wrong can be faster. This page shows the time and the error of "
    "each such choice, next to Bullet's own way. Exact answers come from separate code, which "
    "shares nothing with the methods.";
constexpr const char* kAdvice =
    "Find your task, and read down to the longest time that you can afford. Each row takes more "
    "time than the row above it, and has a smaller error. The table leaves out a choice that is "
    "both "
    "slower and worse than another; the charts have all. It also leaves out a method of Bullet or "
    "of "
    "the paper that gains less than can be measured: at most 5 % of the time of ours, or less than "
    "ours varies from frame to frame.";

std::vector<Choice> allChoices(const AccuracyReport& report) {
    std::vector<Choice> choices;
    for (const Outcome& outcome : report.outcomes) {
        const std::vector<Choice>& own = outcome.findings.choices;
        choices.insert(choices.end(), own.begin(), own.end());
    }
    return choices;
}

/// Without the error, which the result has in words and with its unit.
DataTable adviceForPeople(const AccuracyReport& report) {
    DataTable advice = adviceTable(allChoices(report));
    advice.columns.pop_back();
    for (std::vector<Value>& row : advice.rows) {
        row.pop_back();
    }
    return advice;
}

/// How many experiments and checks, whether all hold, and what was left out.
std::string verdictLine(const AccuracyReport& report) {
    std::size_t checks = 0;
    for (const Outcome& outcome : report.outcomes) {
        checks += outcome.findings.checks.size();
    }
    const std::size_t broken = brokenChecks(report).size();
    const auto counted = [](std::size_t count, const std::string& noun) {
        return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
    };
    return counted(report.outcomes.size(), "experiment") + ", " + counted(checks, "check") + ": " +
           (broken == 0 ? "all hold" : std::to_string(broken) + " BROKEN") +
           leftOutText(report.leftOut);
}

template <class Range, class Make>
Json listOf(const Range& range, const Make& make) {
    Json list = Json::array();
    for (const auto& each : range) {
        list.push_back(make(each));
    }
    return list;
}

Json outcomeJson(const AccuracyReport& report, const Outcome& outcome) {
    const Findings& findings = outcome.findings;
    const auto check = [](const Check& each) -> Json {
        return {{"claim", each.claim}, {"holds", each.holds}, {"evidence", each.evidence}};
    };
    const auto choice = [](const Choice& each) -> Json {
        return {{"task", each.task},
                {"method", each.method},
                {"milliseconds", valueJson(each.milliseconds)},
                {"error", valueJson(each.error)},
                {"result", each.result},
                {"ours", each.isOurs}};
    };
    return {{"schema", "hashphase-accuracy"},
            {"schemaVersion", 1},
            {"provenance", provenanceJson(report.provenance)},
            {"experiment", outcome.experiment->id},
            {"title", outcome.experiment->title},
            {"question", outcome.experiment->question},
            {"quick", report.effort.isQuick},
            {"seed", report.effort.seed},
            {"seconds", outcome.seconds},
            {"settings", findings.settings},
            {"checks", listOf(findings.checks, check)},
            {"conclusions", findings.conclusions},
            {"charts", listOf(findings.charts, chartJson)},
            {"tables", listOf(findings.tables, tableJson)},
            {"choices", listOf(findings.choices, choice)}};
}

void printOutcome(const Outcome& outcome, bool isVerbose, const Console& console) {
    const auto& [experiment, findings, seconds] = outcome;
    const auto print = [&console](const std::string& text, std::size_t indent) {
        console.out << wrapped(text, lineWidth(console), indent) << '\n';
    };
    std::string opening = std::string(experiment->id) + ' ' + std::string(experiment->title);
    opening += isVerbose ? ": " + std::string(experiment->question)
                         : ", " + fixed(seconds, seconds < 10 ? 1 : 0) + " s";
    print(opening, 0);
    if (isVerbose) {
        for (const DataTable& table : findings.tables) {
            console.out << '\n';
            printTable(table, console.out);
        }
        console.out << '\n';
    }
    for (const Check& check : findings.checks) {
        print(
            (check.holds ? "  holds   " : "  BROKEN  ") + check.claim + " (" + check.evidence + ")",
            10);
    }
    if (isVerbose) {
        for (const std::string& conclusion : findings.conclusions) {
            print("  " + conclusion, 2);
        }
    }
    console.out << '\n';
}

/// Task by task, a line for each choice.
void printAdvice(const DataTable& advice, const Console& console) {
    if (advice.rows.empty()) {
        return;
    }
    printSentences({"What to choose, in milliseconds. Of a task, each choice takes longer than the "
                    "one above it, and gets less wrong."},
                   console);
    std::string task;
    for (const std::vector<Value>& row : advice.rows) {
        if (valueText(row[0]) != task) {
            task = valueText(row[0]);
            printSentences({task}, console);
        }
        constexpr std::size_t kIndent = 12;
        std::string line = "  " + cellText(row[1], advice.columns[1]);
        line.resize(std::max(line.size() + 1, kIndent), ' ');
        line += valueText(row[2]) + ": " + valueText(row[3]);
        console.out << wrapped(line, lineWidth(console), kIndent) << '\n';
    }
    console.out << '\n';
}

PageSection sectionOf(const Outcome& outcome, const Effort& effort) {
    const Findings& findings = outcome.findings;
    PageSection section{
        std::string(outcome.experiment->id) + " " + std::string(outcome.experiment->title),
        {std::string(outcome.experiment->question)},
        findings.conclusions,
        findings.checks,
        findings.charts,
        findings.tables,
        findings.settings};
    section.settings.push_back("It took " + fixed(outcome.seconds, 1) + " s" +
                               (effort.isQuick ? " with --quick, which measures less" : "") +
                               "; seed " + std::to_string(effort.seed) + ".");
    return section;
}

}  // namespace

std::vector<std::string> brokenChecks(const AccuracyReport& report) {
    std::vector<std::string> broken;
    for (const Outcome& outcome : report.outcomes) {
        for (const Check& check : outcome.findings.checks) {
            if (!check.holds) {
                broken.push_back(std::string(outcome.experiment->id) + ": " + check.claim + " (" +
                                 check.evidence + ")");
            }
        }
    }
    return broken;
}

DataTable adviceTable(std::span<const Choice> choices) {
    Measurements all;
    all.create("choices", {"task", "milliseconds", "method", "result", "error", "ours", "low"});
    for (const Choice& each : choices) {
        all.add("choices", {{"task", each.task},
                            {"milliseconds", each.milliseconds},
                            {"method", each.method},
                            {"result", each.result},
                            {"error", each.error},
                            {"ours", each.isOurs},
                            {"low", each.low > 0 ? Datum(each.low) : Datum()}});
    }
    DataTable table = all.ask(R"sql(
        WITH numbered AS (SELECT rowid AS number, * FROM choices),
             worth AS (SELECT * FROM numbered AS other WHERE ours OR NOT EXISTS (
                 SELECT * FROM choices AS own
                 WHERE own.ours AND own.task = other.task AND own.error <= other.error
                       AND (own.milliseconds <= 1.05 * other.milliseconds
                            OR own.low <= other.milliseconds)))
        SELECT task, milliseconds, method, result, error FROM (
            SELECT *, min(number) OVER (PARTITION BY task) AS first,
                   min(error) OVER (PARTITION BY task ORDER BY milliseconds, error, number
                                    ROWS BETWEEN UNBOUNDED PRECEDING AND 1 PRECEDING) AS least
            FROM worth ORDER BY first, milliseconds, error, number)
        WHERE least IS NULL OR error < least)sql");
    constexpr std::array titles{"task", "time [ms]", "method", "result", "error"};
    for (std::size_t i = 0; i < titles.size(); ++i) {
        table.columns[i].title = titles[i];
    }
    return table;
}

void printReport(const AccuracyReport& report, bool isVerbose, const Console& console) {
    for (const Outcome& outcome : report.outcomes) {
        printOutcome(outcome, isVerbose, console);
    }
    printAdvice(adviceForPeople(report), console);
    printProvenance(report.provenance, console);
    printVerdict(verdictLine(report), console);
    printSentences(brokenChecks(report), console);
}

Page pageOf(const AccuracyReport& report) {
    const std::vector<std::string> broken = brokenChecks(report);
    Page page{"What accuracy costs in time",
              kIntroduction,
              verdictLine(report) + ".",
              std::nullopt,
              {},
              report.provenance};
    for (const std::string& each : broken) {
        page.verdict += " BROKEN: " + each + ".";
    }
    DataTable advice = adviceForPeople(report);
    if (!advice.rows.empty()) {
        page.sections.push_back({"What to choose", {kAdvice}, {}, {}, {}, {std::move(advice)}, {}});
    }
    for (const Outcome& outcome : report.outcomes) {
        if (!outcome.findings.checks.empty()) {
            page.holds = broken.empty();
        }
        page.sections.push_back(sectionOf(outcome, report.effort));
    }
    return page;
}

void writeReport(const AccuracyReport& report, const std::string& folder) {
    ResultFaults faults;
    const auto write = [&](const std::string& name, const auto& writeTo) {
        faults.collect([&] { ResultFile(folder + "/" + name).write(writeTo); });
    };
    for (const Outcome& outcome : report.outcomes) {
        write(std::string(outcome.experiment->id) + ".json",
              [&](std::ostream& file) { file << textOf(outcomeJson(report, outcome)); });
        for (const Chart& chart : outcome.findings.charts) {
            write(chart.name + ".csv", [&](std::ostream& file) { writeCsv(chart.data, file); });
        }
    }
    write("advice.csv",
          [&](std::ostream& file) { writeCsv(adviceTable(allChoices(report)), file); });
    faults.throwIfAny();
}

}  // namespace hashphase::demos
