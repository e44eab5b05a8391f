// SPDX-License-Identifier: Zlib
#include <demos/paper/paper.hpp>
#include <demos/paper/paper_command.hpp>
#include <demos/paper/paper_report.hpp>
#include <demos/paper/paper_tables.hpp>
#include <demos/report/json_values.hpp>
#include <tests/demos/temporary_folder.hpp>

#include <gtest/gtest.h>

#include <array>
#include <iterator>
#include <sstream>
#include <tuple>

namespace hashphase::demos {
namespace {

struct PaperOutput {
    int exitCode = 0;
    std::string out;
    std::string err;
};

PaperOutput runPaperCommand(std::vector<std::string> arguments) {
    std::ostringstream out;
    std::ostringstream err;
    arguments.insert(arguments.begin(), "paper");
    const std::array subcommands{paperCommand()};
    PaperOutput output;
    output.exitCode = runProgram(arguments, subcommands, {out, err, false, "hashphase test"});
    output.out = out.str();
    output.err = err.str();
    return output;
}

std::string contentsOfPaperFile(const std::string& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// A method that forgets the last thing that it has found.
class Forgetful final : public PhaseMethod {
public:
    explicit Forgetful(std::unique_ptr<PhaseMethod> method) : method_(std::move(method)) {}

    void hash(const TestBed& bed) override { method_->hash(bed); }
    void run(const TestBed& bed) override { method_->run(bed); }
    [[nodiscard]] PhaseAnswer answer() const override {
        PhaseAnswer answer = method_->answer();
        if (!answer.found.empty()) {
            answer.found.pop_back();
        }
        return answer;
    }
    [[nodiscard]] std::size_t memoryBytes() const override { return method_->memoryBytes(); }

private:
    std::unique_ptr<PhaseMethod> method_;
};

constexpr PhaseEffort kBrief{.frames = 6, .fewestFrames = 2, .methodMilliseconds = 1e9};
constexpr std::uint32_t kFew = 1'500;

TEST(PrintedFigures, AreThoseOfThePaper) {
    EXPECT_EQ(printedRate(Phase::collision, 2'500, std::nullopt), "25");
    EXPECT_EQ(printedRate(Phase::collision, 20'000, 25.0), "50");
    EXPECT_EQ(printedRate(Phase::collision, 50'000, 5.0), "29");
    EXPECT_EQ(printedRate(Phase::collision, 10'000, 100.0), "2");
    EXPECT_EQ(printedRate(Phase::visibility, 5'000, std::nullopt), "16");
    EXPECT_EQ(printedRate(Phase::visibility, 50'000, 100.0), "40");
    EXPECT_EQ(printedRate(Phase::ai, 10'000, 50.0), "33");
    EXPECT_EQ(printedRate(Phase::ai, 50'000, 5.0), "8");
    EXPECT_EQ(printedRate(Phase::ai, 50'000, 100.0), "<1");
    EXPECT_EQ(printedRate(Phase::ai, 30'000, 5.0), "");
    EXPECT_EQ(printedRate(Phase::ai, 500, 7.0), "");
    // Of each figure: 60+, 60, numbers and <1 in all seven rows and six columns.
    std::array<std::size_t, 3> tooSlow{};
    std::array<std::size_t, 3> smooth{};
    for (const Phase phase : kPhases) {
        for (const std::uint32_t objects : kPrintedObjects) {
            std::vector<std::optional<double>> columns(kPrintedCellSizes.begin(),
                                                       kPrintedCellSizes.end());
            columns.emplace_back();
            for (const std::optional<double> cellSize : columns) {
                const std::string_view printed = printedRate(phase, objects, cellSize);
                ASSERT_FALSE(printed.empty());
                tooSlow[static_cast<std::size_t>(phase)] += isTooSlow(printed) ? 1 : 0;
                smooth[static_cast<std::size_t>(phase)] += printed == "60+" ? 1 : 0;
            }
        }
    }
    EXPECT_EQ(tooSlow, (std::array<std::size_t, 3>{10, 4, 13}));
    EXPECT_EQ(smooth, (std::array<std::size_t, 3>{28, 33, 24}));
}

TEST(PrintedFigures, NeverMakeANumberOfACensoredValue) {
    EXPECT_EQ(exactRate("60+"), std::nullopt);
    EXPECT_EQ(exactRate("<1"), std::nullopt);
    EXPECT_EQ(exactRate(""), std::nullopt);
    EXPECT_EQ(exactRate("49"), 49);
    EXPECT_FALSE(isTooSlow("60+"));
    EXPECT_TRUE(isTooSlow("<1"));
    EXPECT_TRUE(isTooSlow("19"));
    EXPECT_FALSE(isTooSlow("20"));
    EXPECT_EQ(gradeOfPrinted("60+"), Grade::kGood);
    EXPECT_EQ(gradeOfPrinted("60"), Grade::kGood);
    EXPECT_EQ(gradeOfPrinted("23"), Grade::kFair);
    EXPECT_EQ(gradeOfPrinted("<1"), Grade::kPoor);
}

TEST(PaperPhases, FindWhatBruteForceFindsInEveryFrame) {
    for (const Phase phase : kPhases) {
        const PhaseResult result =
            measurePhase({.phase = phase, .objects = kFew, .seed = 3, .aiRadius = 12},
                         figureMethods(phase, kFew, 12), kBrief);
        ASSERT_EQ(result.methods.size(), 12U);
        for (const MethodResult& method : result.methods) {
            EXPECT_EQ(method.frameMs.size(), kBrief.frames) << describe(method);
            EXPECT_GE(method.checkedFrames, kBrief.frames) << describe(method);
            EXPECT_EQ(method.wrongFrames, 0U) << describe(method) << ": " << method.fault;
        }
        EXPECT_GT(result.found, 50U);
    }
}

TEST(PaperPhases, AreComparedForSomeObjectsWhereThereAreMany) {
    TestBed bed(kFew, 5);
    const Subjects some = Subjects::drawn(kFew, 40, 7);
    EXPECT_FALSE(some.areAll());
    EXPECT_GT(some.list().size(), 30U);
    for (const Phase phase : kPhases) {
        const auto judge = bruteForce(phase, some, 12);
        const auto method = methodSpec(phase, MethodKind::hashphase, std::nullopt, 12).make(bed);
        judge->run(bed);
        method->hash(bed);
        method->run(bed);
        EXPECT_EQ(faultOf(phase, method->answer(), judge->answer(), some), "");
        PhaseAnswer broken = method->answer();
        broken.found.clear();
        EXPECT_NE(faultOf(phase, broken, judge->answer(), some), "");
    }
}

TEST(PaperPhases, AreComparedByHeightsAndSpeedsToo) {
    const Subjects one = Subjects::all(1);
    EXPECT_EQ(faultOf(Phase::collision, {{}, {1, 2, 3, 4}}, {{}, {1, 2, 3, 4.0001F}}, one), "");
    EXPECT_NE(faultOf(Phase::collision, {{}, {1, 2, 3, 4}}, {{}, {1.5F, 2, 3, 4}}, one), "");
    EXPECT_NE(faultOf(Phase::collision, {{}, {1, 2, 3, 4}}, {{}, {1, 2, 3}}, one), "");
}

TEST(PaperPhases, FailTheRunWhenAMethodIsBroken) {
    for (const Phase phase : kPhases) {
        std::vector<MethodSpec> specs = figureMethods(phase, kFew, 12);
        MethodSpec& broken = specs.back();
        broken.make = [right = broken.make](const TestBed& bed) {
            return std::make_unique<Forgetful>(right(bed));
        };
        PaperResults results;
        results.figures.push_back(measurePhase(
            {.phase = phase, .objects = kFew, .seed = 3, .aiRadius = 12}, specs, kBrief));
        results.checks = {agreement(results.figures)};
        const MethodResult& wrong = results.figures[0].methods.back();
        EXPECT_GE(wrong.checkedFrames, kBrief.frames);
        EXPECT_EQ(wrong.wrongFrames, wrong.checkedFrames);
        EXPECT_EQ(results.figures[0].methods[1].wrongFrames, 0U);
        EXPECT_FALSE(results.allHold());
        EXPECT_EQ(exitCodeOf(results), kExitCheckFailed);
        EXPECT_NE(results.checks[0].evidence.find("hashphase"), std::string::npos);
        EXPECT_NE(verdictLine(results).find("NO, see above"), std::string::npos);
    }
}

TEST(BoundingVolumes, PassAllThatTouchAndFewerTheBetterTheyFit) {
    const VolumeResults results = measureVolumes(1'000, 2, 1);
    ASSERT_EQ(results.volumes.size(), 3U);
    EXPECT_TRUE(results.checks[0].holds) << results.checks[0].evidence;
    const auto& [sphere, aabb, obb] =
        std::tie(results.volumes[0], results.volumes[1], results.volumes[2]);
    EXPECT_GT(sphere.touching, 50);
    EXPECT_EQ(sphere.touching, aabb.touching);
    EXPECT_EQ(sphere.touching, obb.touching);
    EXPECT_GT(sphere.passed, aabb.passed);
    EXPECT_GT(aabb.passed, obb.passed);
    EXPECT_GE(obb.passed, obb.touching);
}

TEST(PaperTables, MarkWhatIsTooSlow) {
    EXPECT_EQ(gradeOf(60.0), Grade::kGood);
    EXPECT_EQ(gradeOf(59.9), Grade::kFair);
    EXPECT_EQ(gradeOf(20.0), Grade::kFair);
    EXPECT_EQ(gradeOf(19.9), Grade::kPoor);
    EXPECT_EQ(gradeOf(std::nullopt), Grade::kNone);
    EXPECT_EQ(rateText(1234.6), "1,234");
    EXPECT_EQ(rateText(59.9), "59");
    EXPECT_EQ(rateText(0.31), "0.3");
    std::ostringstream out;
    writeGradedTable({"<b>",
                      {"a", "b", "c"},
                      {"n", "who", "m"},
                      {{{"1"}, {"x"}, {"<1", Grade::kPoor}}, {{"1"}, {"y"}, {"30", Grade::kFair}}}},
                     out);
    EXPECT_NE(out.str().find("<td class=\"number poor\">&lt;1!</td>"), std::string::npos)
        << out.str();
    EXPECT_NE(out.str().find("<td class=\"number fair\">30~</td>"), std::string::npos);
    EXPECT_NE(out.str().find("rowspan=\"2\">1</th>"), std::string::npos);
    EXPECT_EQ(out.str().find("<b>"), std::string::npos);
}

TEST(PaperCommand, WritesTheFiguresAsTextJsonCsvAndPage) {
    const TemporaryFolder folder;
    const std::string json = folder.file("paper.json");
    const std::string csv = folder.file("paper.csv");
    const std::string html = folder.file("paper.html");
    const PaperOutput output =
        runPaperCommand({"--quick", "--objects", "500,1000", "--frames", "2", "--json", json,
                         "--csv", csv, "--html", html, "--quiet"});
    EXPECT_EQ(output.exitCode, kExitOk) << output.out << output.err;
    EXPECT_EQ(output.err, "");
    EXPECT_NE(output.out.find("Figure 15, AI: frames a second"), std::string::npos);
    EXPECT_NE(output.out.find("the same as brute force: yes\n"), std::string::npos);
    const Json read = Json::parse(contentsOfPaperFile(json));
    EXPECT_EQ(read["schema"], "hashphase-paper");
    EXPECT_EQ(read["schemaVersion"], 1);
    EXPECT_EQ(read["checks"][0]["holds"], true);
    const Json& first = read["measurements"][0];
    EXPECT_EQ(first["figure"], 13);
    EXPECT_EQ(first["objects"], 500);
    EXPECT_EQ(first["paper"], "60+");
    EXPECT_TRUE(first["cell_m"].is_null());
    EXPECT_GT(first["frame_ms"].get<double>(), 0);
    EXPECT_EQ(first["wrong_frames"], 0);
    EXPECT_EQ(read["neighboursByRadius"].size(), 5U);
    EXPECT_EQ(read["boundingVolumes"].size(), 3U);
    EXPECT_EQ(contentsOfPaperFile(csv).rfind("part,figure,phase,objects,method,cell_m,", 0), 0U);
    EXPECT_NE(contentsOfPaperFile(html).find("<td class=\"number good\">60+</td>"),
              std::string::npos);
}

TEST(PaperCommand, LeavesOutWhatTheTimeLimitDoesNotAllow) {
    const PaperOutput output = runPaperCommand({"--time-limit", "1e-9", "--quiet"});
    EXPECT_EQ(output.exitCode, kExitOk) << output.err;
    EXPECT_NE(output.out.find("Left out for want of time: collision of 50,000\n"),
              std::string::npos);
}

TEST(PaperCommand, RefusesWhatItCannotRun) {
    for (const std::vector<std::string>& arguments : {std::vector<std::string>{"--objects", "1"},
                                                      {"--objects", "2000000"},
                                                      {"--objects", "many"},
                                                      {"--frames", "0"},
                                                      {"--seed", "-1"},
                                                      {"--time-limit", "0"},
                                                      {"--radius", "-1"},
                                                      {"--radius", "nan"},
                                                      {"--object", "500"},
                                                      {"--html", "/no/such/folder/paper.html"}}) {
        const PaperOutput output = runPaperCommand(arguments);
        EXPECT_EQ(output.exitCode, kExitUsage) << arguments[0] << ' ' << arguments[1];
        EXPECT_NE(output.err, "");
    }
}

}  // namespace
}  // namespace hashphase::demos
