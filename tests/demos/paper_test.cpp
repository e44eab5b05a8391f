// SPDX-License-Identifier: Zlib
#include <broadphase/grid.hpp>
#include <demos/paper/paper.hpp>
#include <demos/paper/paper_command.hpp>
#include <demos/paper/paper_report.hpp>
#include <demos/report/json_values.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <set>
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

/// A method that from that frame on forgets the last thing that it has found.
class Forgetful final : public PhaseMethod {
public:
    explicit Forgetful(std::unique_ptr<PhaseMethod> method, int firstWrong = 0)
        : method_(std::move(method)), rightFrames_(firstWrong) {}

    void hash(const TestBed& bed) override { method_->hash(bed); }
    void run(const TestBed& bed) override {
        method_->run(bed);
        --rightFrames_;
    }
    void stand(const TestBed& bed) override { method_->stand(bed); }
    [[nodiscard]] PhaseAnswer answer() const override {
        PhaseAnswer answer = method_->answer();
        if (rightFrames_ < 0 && !answer.found.empty()) {
            answer.found.pop_back();
        }
        return answer;
    }
    [[nodiscard]] std::size_t memoryBytes() const override { return method_->memoryBytes(); }

private:
    std::unique_ptr<PhaseMethod> method_;
    int rightFrames_;  // that are left
};

/// As the options ask, but with time for all frames on the slowest machine.
PhaseEffort quickEffort() {
    PaperOptions options;
    options.quick = true;
    PhaseEffort effort = planOf(options).effort;
    effort.methodMilliseconds = 1e9;
    effort.slowMilliseconds = 1e9;
    return effort;
}

constexpr PhaseEffort kBrief{
    .frames = 6, .fewestFrames = 2, .methodMilliseconds = 1e9, .slowMilliseconds = 1e9};
constexpr std::uint32_t kFew = 1'500;

TEST(PaperPhases, FindWhatBruteForceFindsInEveryFrame) {
    for (const Phase phase : kPhases) {
        const PhaseResult result =
            measurePhase({.phase = phase, .objects = kFew, .seed = 3, .aiRadius = 12},
                         figureMethods(phase, kFew, 12), kBrief);
        ASSERT_EQ(result.methods.size(), 12U);
        EXPECT_EQ(result.side, 400.0F);
        EXPECT_EQ(result.triangles, 3'200U);
        for (const MethodResult& method : result.methods) {
            EXPECT_EQ(method.frameMs.size(), kBrief.frames) << describe(method);
            EXPECT_EQ(method.checkedFrames, kBrief.frames + 1) << describe(method);
            EXPECT_EQ(method.checkedTimed, kBrief.frames) << describe(method);
            EXPECT_EQ(method.checkedObjects, (kBrief.frames + 1) * kFew) << describe(method);
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
        judge->stand(bed);
        method->hash(bed);
        method->run(bed);
        method->stand(bed);
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
        EXPECT_EQ(results.outcome(), CheckOutcome::broken);
        EXPECT_EQ(exitCodeOf(results), kExitCheckFailed);
        EXPECT_NE(results.checks[0].evidence.find("hashphase"), std::string::npos);
        EXPECT_NE(verdictLine(results).find("NO, see above"), std::string::npos);
    }
}

TEST(PaperPhases, CatchWhatGoesWrongInALateFrameOfAQuickRun) {
    for (const Phase phase : kPhases) {
        std::vector<MethodSpec> specs{methodSpec(phase, MethodKind::hashphase, std::nullopt, 12),
                                      methodSpec(phase, MethodKind::paperGrid, 10, 12)};
        specs.front().make = [right = specs.front().make](const TestBed& bed) {
            return std::make_unique<Forgetful>(right(bed), 5);
        };
        for (const bool isHurried : {false, true}) {
            PhaseEffort effort = quickEffort();
            effort.isHurried = isHurried;
            const std::array result{measurePhase(
                {.phase = phase, .objects = 900, .seed = 3, .aiRadius = 12}, specs, effort)};
            const MethodResult& wrong = result[0].methods.front();
            EXPECT_EQ(wrong.frameMs.size(), effort.frames);
            EXPECT_EQ(wrong.checkedFrames, isHurried ? 1U : 2U);
            EXPECT_EQ(wrong.checkedTimed, 1U);
            EXPECT_EQ(wrong.wrongFrames, 1U);
            EXPECT_EQ(result[0].methods.back().wrongFrames, 0U);
            EXPECT_EQ(agreement(result).outcome, CheckOutcome::broken);
        }
    }
}

TEST(PaperPhases, TellHowManyTimedFramesAreChecked) {
    const std::vector<MethodSpec> specs{
        methodSpec(Phase::ai, MethodKind::hashphase, std::nullopt, 12)};
    const std::array result{measurePhase({Phase::ai, 300, 3, 12}, specs, quickEffort())};
    EXPECT_EQ(agreement(result).evidence, "1 of 6 timed frames checked, and 1 that are not timed");
}

TEST(PaperPhases, AreNotCheckedWhereNoFrameWas) {
    const std::array result{measurePhase({Phase::ai, 300, 3, 12}, figureMethods(Phase::ai, 300, 12),
                                         kBrief, [] { return true; })};
    EXPECT_EQ(agreement(result).outcome, CheckOutcome::notChecked);
    PaperResults results;
    EXPECT_EQ(results.outcome(), CheckOutcome::notChecked);
    results.checks = {{"", CheckOutcome::holds, ""}, agreement(result)};
    EXPECT_EQ(results.outcome(), CheckOutcome::notChecked);
    EXPECT_EQ(exitCodeOf(results), kExitCheckFailed);
    EXPECT_NE(verdictLine(results).find("brute force: not checked"), std::string::npos);
    results.checks.pop_back();
    EXPECT_EQ(exitCodeOf(results), kExitOk);
}

TEST(PaperPhases, HoldNoBytesWhereTheyAreNotMeasured) {
    const PhaseResult result =
        measurePhase({Phase::collision, 300, 3, 12}, figureMethods(Phase::collision, 300, 12),
                     kBrief, [] { return true; });
    for (const MethodResult& method : result.methods) {
        EXPECT_FALSE(method.isMeasured());
        EXPECT_FALSE(method.bytes) << describe(method);
    }
}

TEST(PaperPhases, CountThePairsAndTheNumbersOfProxiesThatTheyKeep) {
    TestBed bed(kFew, 5);
    for (const MethodKind kind : {MethodKind::unoptimized, MethodKind::paperGrid}) {
        const auto method = methodSpec(Phase::collision, kind, 10, 12).make(bed);
        method->hash(bed);
        const std::size_t before = method->memoryBytes();
        method->run(bed);
        const std::size_t pairs = method->answer().found.size();
        EXPECT_GT(pairs, 50U);
        constexpr std::size_t kState = sizeof(float) + sizeof(Vector3<float>);
        EXPECT_GE(method->memoryBytes(), before + pairs * sizeof(std::uint64_t) + kFew * kState);
    }
    Grid<float> grid({.cellSize = 10});
    grid.reserve(bed.objects());
    for (const Aabb<float>& box : bed.boxes()) {
        static_cast<void>(grid.add(box));
    }
    const auto culling = methodSpec(Phase::visibility, MethodKind::hashphase, 10, 12).make(bed);
    EXPECT_GE(culling->memoryBytes(), grid.memoryBytes() + kFew * sizeof(ProxyId));
}

/// Tells when it runs.
class Diary final : public PhaseMethod {
public:
    Diary(std::vector<int>& entries, int name) : entries_(entries), name_(name) {}
    void run(const TestBed& /*bed*/) override { entries_.push_back(name_); }
    [[nodiscard]] PhaseAnswer answer() const override { return {}; }
    [[nodiscard]] std::size_t memoryBytes() const override { return 0; }

private:
    std::vector<int>& entries_;
    int name_;
};

std::vector<int> turnsOf(std::size_t methods, std::uint64_t seed, bool isHurried) {
    std::vector<int> entries;
    std::vector<MethodSpec> specs;
    while (specs.size() < methods) {
        specs.push_back({MethodKind::hashphase, std::nullopt,
                         [&, name = static_cast<int>(specs.size())](auto&) {
                             return std::make_unique<Diary>(entries, name);
                         }});
    }
    PhaseEffort effort = kBrief;
    effort.isHurried = isHurried;
    static_cast<void>(measurePhase({Phase::visibility, 10, seed, 12}, specs, effort));
    return entries;
}

TEST(PaperPhases, TakeTurnsInAnOrderThatIsDrawnAnewInEachFrame) {
    const std::vector<int> turns = turnsOf(4, 3, false);
    EXPECT_EQ(turns, turnsOf(4, 3, false));
    EXPECT_NE(turns, turnsOf(4, 4, false));
    ASSERT_EQ(turns.size(), 4 * (kBrief.frames + 1));
    std::set<int> after0;
    for (std::size_t i = 0; i + 1 < turns.size(); ++i) {
        if (turns[i] == 0 && (i + 1) % 4 != 0) {
            after0.insert(turns[i + 1]);
        }
    }
    EXPECT_GT(after0.size(), 1U);
    for (auto frame = turns.begin(); frame != turns.end(); frame += 4) {
        EXPECT_EQ(std::set<int>(frame, frame + 4).size(), 4U);
    }
    const std::vector<int> hurried = turnsOf(4, 3, true);
    EXPECT_TRUE(std::is_sorted(hurried.begin(), hurried.begin() + 4));
}

TEST(PaperResults, HaveHashphaseBeforeItsRivalsWhereTheTimeIsLimited) {
    PaperOptions options;
    EXPECT_FALSE(planOf(options).effort.isHurried);
    options.timeLimit = 10;
    options.objects = {100, 200};
    PaperPlan plan = planOf(options);
    plan.effort = kBrief;
    plan.effort.isHurried = true;
    std::vector<std::string> steps;
    PaperWatch watch;
    watch.tellProgress = [&](std::size_t, std::string_view what) { steps.emplace_back(what); };
    watch.isTimeUp = [&] { return steps.size() > 12; };  // as the first un-optimized one begins
    const PaperResults results = measurePaper(plan, watch);
    ASSERT_GT(steps.size(), 18U);
    EXPECT_EQ(steps[0], "collision of 100, hashphase");
    EXPECT_EQ(steps[5], "AI of 200, hashphase");
    EXPECT_EQ(steps[6], "collision of 100, paper's grid");
    EXPECT_EQ(steps[17], "AI of 200, un-optimized");
    ASSERT_EQ(results.figures.size(), 6U);
    for (const PhaseResult& figure : results.figures) {
        EXPECT_EQ(figure.methods.size(), 11U);
        for (const MethodResult& method : figure.methods) {
            EXPECT_TRUE(method.isMeasured());
            EXPECT_GE(method.checkedTimed, 1U);
        }
    }
    EXPECT_EQ(results.outcome(), CheckOutcome::holds);
    EXPECT_EQ(results.leftOut.front(), "collision of 100, un-optimized");
}

TEST(BoundingVolumes, StopWhenTheTimeIsUp) {
    const VolumeResults none = measureVolumes(200, kBrief, 1, [] { return true; });
    EXPECT_TRUE(none.volumes.empty());
    int left = 3;
    const VolumeResults some = measureVolumes(200, kBrief, 1, [&] { return left-- == 0; });
    EXPECT_EQ(some.frames, 3U);
    EXPECT_EQ(some.volumes[2].exactMs.size(), 3U);
    EXPECT_EQ(some.volumes[0].touching, some.volumes[2].touching);
}

TEST(BoundingVolumes, TakeNoMoreFramesThanTheEffortAllows) {
    const VolumeResults few =
        measureVolumes(200, {.frames = 6, .fewestFrames = 2, .methodMilliseconds = 0}, 1);
    EXPECT_EQ(few.frames, 2U);
    EXPECT_EQ(few.volumes[0].exactMs.size(), 2U);
}

TEST(BoundingVolumes, PassAllThatTouchAndFewerTheBetterTheyFit) {
    const VolumeResults results = measureVolumes(1'000, {.frames = 2, .fewestFrames = 2}, 1);
    ASSERT_EQ(results.volumes.size(), 3U);
    EXPECT_EQ(results.checks[0].outcome, CheckOutcome::holds) << results.checks[0].evidence;
    const auto& [sphere, aabb, obb] =
        std::tie(results.volumes[0], results.volumes[1], results.volumes[2]);
    EXPECT_GT(sphere.touching, 50);
    EXPECT_EQ(sphere.touching, aabb.touching);
    EXPECT_EQ(sphere.touching, obb.touching);
    EXPECT_GT(sphere.passed, aabb.passed);
    EXPECT_GT(aabb.passed, obb.passed);
    EXPECT_GE(obb.passed, obb.touching);
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
    EXPECT_GT(first["ground_ms"].get<double>(), 0);
    EXPECT_EQ(first["side_m"], 400);
    EXPECT_EQ(first["triangles"], 3'200);
    EXPECT_GE(first["checked_timed_frames"], 2);
    EXPECT_TRUE(read["realTime"]["AI"]["grid"].contains("paperToday"));
    EXPECT_EQ(read["neighboursByRadius"].size(), 5U);
    EXPECT_EQ(read["boundingVolumes"].size(), 3U);
    EXPECT_EQ(contentsOfPaperFile(csv).rfind("part,figure,phase,objects,method,cell_m,", 0), 0U);
    EXPECT_NE(contentsOfPaperFile(html).find("<td class=\"number good\">60+</td>"),
              std::string::npos);
}

TEST(PaperCommand, LeavesOutWhatTheTimeLimitDoesNotAllowAndClaimsNothing) {
    const TemporaryFolder folder;
    const std::string json = folder.file("paper.json");
    const PaperOutput output = runPaperCommand({"--time-limit", "1e-9", "--json", json, "--quiet"});
    EXPECT_EQ(output.exitCode, kExitCheckFailed) << output.err;
    EXPECT_NE(output.out.find("Left out for want of time: collision of 50,000, hashphase\n"),
              std::string::npos);
    EXPECT_NE(output.out.find("the same as brute force: not checked\n"), std::string::npos);
    const Json read = Json::parse(contentsOfPaperFile(json));
    EXPECT_TRUE(read["checks"][0].at("holds").is_null());
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
