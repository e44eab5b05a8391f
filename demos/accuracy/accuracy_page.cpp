// SPDX-License-Identifier: Zlib
#include <demos/accuracy/accuracy_page.hpp>

#include <demos/accuracy/advice.hpp>
#include <demos/console/format.hpp>

namespace hashphase::demos {
namespace {

constexpr const char* kIntroduction =
    "hashphase is a spatial hash that replaces the broadphase of the Bullet physics engine. Where "
    "a "
    "program may be a little wrong, it can be faster: this page shows what each such choice costs "
    "in "
    "time and what it gets wrong, with Bullet's own way beside it. Errors are counted against "
    "exact "
    "answers that none of the methods had a part in.";

PageSection adviceSection(const std::vector<Choice>& choices) {
    PageSection section;
    section.heading = "What to choose";
    section.sentences = {
        "Find your task and read down to the most that you can afford: each row costs more time "
        "than "
        "the one above it, and gets less wrong. What is both slower and worse than another choice "
        "is "
        "left out here, but not in the charts."};
    section.tables = {adviceTable(choices)};
    return section;
}

PageSection sectionOf(const Outcome& outcome, const Effort& effort) {
    const Findings& findings = outcome.findings;
    PageSection section;
    section.heading =
        std::string(outcome.experiment->id) + " " + std::string(outcome.experiment->title);
    section.sentences = {std::string(outcome.experiment->question)};
    section.conclusions = findings.conclusions;
    section.checks = findings.checks;
    section.tables = findings.tables;
    section.charts = findings.charts;
    section.settings = findings.settings;
    section.settings.push_back("It took " + fixed(outcome.seconds, 1) + " s" +
                               (effort.isQuick ? " with --quick, which measures less" : "") +
                               "; seed " + std::to_string(effort.seed) + ".");
    return section;
}

}  // namespace

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
    const std::vector<Choice> choices = allChoices(report);
    if (!choices.empty()) {
        page.sections.push_back(adviceSection(choices));
    }
    for (const Outcome& outcome : report.outcomes) {
        if (!outcome.findings.checks.empty()) {
            page.holds = broken.empty();
        }
        page.sections.push_back(sectionOf(outcome, report.effort));
    }
    return page;
}

}  // namespace hashphase::demos
