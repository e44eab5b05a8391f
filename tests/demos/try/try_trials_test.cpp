// SPDX-License-Identifier: Zlib

// The trials of trials.txt, and of reports.txt what is said of steps that it makes up.

#include <demos/try/try_report.hpp>
#include <tests/demos/try/try_output.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <ostream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {
namespace {

using tryout::StepRow;
using tryout::Times;

constexpr int kSkipped = 77;  // the status of a script

// --- Blocks of a file ----------------------------------------------------------------------------

struct Block {
    std::string name;
    std::string words;
    int status = -1;
    std::vector<std::string> given;  // behind "$ "
    std::vector<std::string> lines;  // that are expected
};

void PrintTo(const Block& block, std::ostream* out) {
    *out << block.words;
}

/// "Name: words -> status"
Block headOf(const std::string& line) {
    const std::size_t colon = line.find(": ");
    const std::size_t arrow = line.rfind("-> ");
    return {line.substr(0, colon),
            line.substr(colon + 2, arrow - colon - 2),
            std::stoi(line.substr(arrow + 3)),
            {},
            {}};
}

std::vector<Block> blocksOf(const std::string& name) {
    std::vector<Block> blocks;
    std::ifstream file(HASHPHASE_TRIALS_FOLDER "/" + name);
    bool isWithin = false;
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line.starts_with('#')) {
            isWithin = isWithin && !line.empty();
        } else if (!isWithin) {
            blocks.push_back(headOf(line));
            isWithin = true;
        } else if (line.starts_with("$ ")) {
            blocks.back().given.push_back(line.substr(2));
        } else {
            blocks.back().lines.push_back(line);
        }
    }
    return blocks;
}

const auto nameOfBlock = [](const auto& each) { return each.param.name; };

// --- What is expected ----------------------------------------------------------------------------

/// `pointer` begins with '/', or is empty where the figure is found.
void expectFigure(const Json& found, std::string_view pointer, std::string expected,
                  const Json& whole) {
    if (!pointer.empty()) {
        const std::string token(pointer.substr(1, pointer.find('/', 1) - 1));
        const std::string_view rest = pointer.substr(1 + token.size());
        if (token == "*") {
            EXPECT_FALSE(found.empty());
            for (const Json& element : found) {
                expectFigure(element, rest, expected, whole);
            }
        } else {
            const Json::json_pointer step("/" + token);
            ASSERT_TRUE(found.contains(step)) << token << " in " << found;
            expectFigure(found[step], rest, expected, whole);
        }
        return;
    }
    const Json figure = found.is_array() ? Json(found.size()) : found;
    const char relation = expected.front();
    if (relation == '<' || relation == '>') {
        expected.erase(0, 1);
    }
    const Json bound = expected.starts_with('/') ? whole.at(Json::json_pointer(expected))
                                                 : Json::parse(expected, nullptr, false);
    if (relation == '<') {
        EXPECT_LT(figure, bound);
    } else if (relation == '>') {
        EXPECT_GT(figure, bound);
    } else if (figure.is_string()) {
        EXPECT_TRUE(has(figure, expected)) << figure;
    } else if (figure.is_number_float() && bound.is_number()) {
        EXPECT_NEAR(figure.get<double>(), bound.get<double>(), 1e-6);
    } else {
        EXPECT_EQ(figure, bound);
    }
}

/// Over the steps of all runs, and `written`: out, json.
bool holds(const std::string& condition, const Output& output) {
    Measurements measured;
    measured.add("written", {{"out", output.out}, {"json", output.json.dump()}});
    std::string columns = "run.key AS run";
    for (const auto& [name, figure] : output.json["runs"][0]["steps"][0].items()) {
        columns += ", json_extract(step.value, '$." + name + "') AS " + name;
    }
    measured.ask(
        "CREATE VIEW steps AS SELECT " + columns +
        " FROM written, json_each(written.json, '$.runs') AS run, json_each(run.value, '$.steps') "
        "AS step");
    return measured.ask("SELECT " + condition).rows.at(0).at(0) == Value(1.0);
}

void expectSaid(const std::vector<std::string>& lines, const Output& output) {
    const std::string all = output.out + output.err;
    for (std::string line : lines) {
        SCOPED_TRACE(line);
        std::ranges::replace(line, '|', '\n');
        const std::size_t end = line.find_first_of(": ");
        const std::string kind = line.starts_with('/') ? "figure" : line.substr(0, end + 1);
        const std::string rest = line.substr(std::min(end + 1, line.size()));
        if (kind == "figure") {
            expectFigure(output.json, std::string_view(line).substr(0, end), rest, output.json);
        } else if (kind == "sql:") {
            EXPECT_TRUE(holds(rest, output)) << all;
        } else if (kind == "last:") {
            EXPECT_TRUE(output.out.ends_with("\n" + rest + "\n")) << all;
        } else if (kind == "not:") {
            EXPECT_FALSE(has(all, rest)) << all;
        } else if (kind == "twice:") {
            const std::size_t first = all.find(rest);
            EXPECT_TRUE(first != std::string::npos && has(all.substr(first + 1), rest)) << all;
        } else {
            EXPECT_TRUE(has(all, line)) << all;
        }
    }
}

// --- Programs that are tried ---------------------------------------------------------------------

class Try : public testing::TestWithParam<Block> {};

TEST_P(Try, Says) {
    const Block& trial = GetParam();
    std::string script;
    for (const std::string& line : trial.given) {
        script += line + "\n";
    }
    const Output output = script.empty() ? tryWords(trial.words) : runScript(script);
    if (output.status == kSkipped) {
        GTEST_SKIP() << output.out;
    }
    EXPECT_EQ(output.status, trial.status) << output.out << output.err;
    expectSaid(trial.lines, output);
}

INSTANTIATE_TEST_SUITE_P(Trials, Try, testing::ValuesIn(blocksOf("trials.txt")), nameOfBlock);

// --- Reports of steps that are made up -----------------------------------------------------------

/// Of "step 2/1.5 pairs 7": by the clock on the wall and the processor's, or the same by both.
StepRow stepOf(std::istream& words) {
    static const std::map<std::string, Times StepRow::*> kTimes{
        {"step", &StepRow::step},
        {"updateAabbs", &StepRow::updateAabbs},
        {"calculate", &StepRow::calculate},
        {"narrowPhase", &StepRow::narrowPhase}};
    static const std::map<std::string, float StepRow::*> kFloats{
        {"rays", &StepRow::rays}, {"allThreads", &StepRow::allProcessor}};
    static const std::map<std::string, std::uint32_t StepRow::*> kCounts{
        {"rayCount", &StepRow::rayCount},
        {"objects", &StepRow::objectCount},
        {"calculations", &StepRow::calculations},
        {"pairs", &StepRow::pairCount},
        {"overlapping", &StepRow::truePairCount}};
    StepRow row{};
    row.calculations = 1;
    row.allProcessor = StepRow::kNotTaken;
    for (std::string key; words >> key;) {
        if (const auto time = kTimes.find(key); time != kTimes.end()) {
            Times& times = row.*time->second;
            words >> times.wall;
            times.processor = times.wall;
            if (words.peek() == '/') {
                words.ignore() >> times.processor;
            }
            row.isStep |= key == "step" ? 1 : 0;
        } else if (const auto number = kFloats.find(key); number != kFloats.end()) {
            words >> row.*number->second;
        } else {
            words >> row.*kCounts.at(key);
        }
    }
    return row;
}

/// Of "bullet, ended with status 3: 98 step 1; 2 step 50"; of what ended with status 0 that is not said.
TriedRun runOf(const std::string& line) {
    TriedRun run;
    std::istringstream parts(line);
    std::string head;
    std::getline(parts, head, ':');
    const std::size_t comma = std::min(head.find(", "), head.size());
    run.broadphase =
        head.substr(0, comma) == "bullet" ? tryout::Broadphase::stock : tryout::Broadphase::hash;
    run.counts.dbvts = 1;
    if (comma < head.size()) {
        run.end.text = head.substr(comma + 2);
        run.end.isCrash = run.end.text.starts_with("was ended");
    }
    for (std::string part; std::getline(parts, part, ';');) {
        std::istringstream words(part);
        std::size_t count = 0;
        words >> count;
        run.rows.insert(run.rows.end(), count, stepOf(words));
    }
    return run;
}

class TryReport : public testing::TestWithParam<Block> {};

TEST_P(TryReport, Says) {
    const Block& block = GetParam();
    Trial trial;
    for (const std::string& line : block.given) {
        if (line.starts_with("machine")) {
            std::istringstream words(line.substr(line.find(' ')));
            words >> trial.provenance.cores >> trial.provenance.coresOfOthers.emplace();
        } else {
            trial.runs.push_back(runOf(line));
        }
    }
    TrialReport report = reportOf(trial);
    std::ostringstream text;
    std::ostringstream json;
    printTrial(report, text);
    writeTrialJson(report, json);
    EXPECT_EQ(report.findings.holds, block.status == 0);
    expectSaid(block.lines, {block.status, text.str(), "", Json::parse(json.str())});
}

INSTANTIATE_TEST_SUITE_P(Reports, TryReport, testing::ValuesIn(blocksOf("reports.txt")),
                         nameOfBlock);

}  // namespace
}  // namespace hashphase::demos
