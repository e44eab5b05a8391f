// SPDX-License-Identifier: Zlib
#include <demos/paper/paper.hpp>
#include <demos/paper/paper_command.hpp>
#include <demos/report/json_values.hpp>
#include <demos/scenes/file_bytes.hpp>
#include <tests/demos/asked.hpp>
#include <tests/demos/typed.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>

#include <array>

namespace hashphase::demos {
namespace {

/// A method that from that frame on forgets the last thing that it has found.
class Forgetful final : public PhaseMethod {
public:
    Forgetful(std::unique_ptr<PhaseMethod> method, int firstWrong)
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

MethodSpec forgetful(MethodSpec spec, int firstWrong = 0) {
    spec.make = [firstWrong](const MethodPlan& plan, const TestBed& bed, const Subjects& subjects) {
        return std::make_unique<Forgetful>(makeMethod(plan, bed, subjects), firstWrong);
    };
    return spec;
}

constexpr PhaseEffort kBrief{
    .frames = 6, .fewestFrames = 2, .methodMilliseconds = 1e9, .slowMilliseconds = 1e9};
constexpr std::uint32_t kFew = 1'500;

/// As the options ask, but with time for all frames on the slowest machine.
PhaseEffort quickEffort() {
    PaperOptions options;
    options.quick = true;
    PhaseEffort effort = planOf(options).effort;
    effort.methodMilliseconds = effort.slowMilliseconds = 1e9;
    return effort;
}

PaperReport reportOf(
    const PhaseTask& task, std::span<const MethodSpec> specs, const PhaseEffort& effort,
    const IsTimeUp& isTimeUp = [] { return false; }) {
    Measurements rows;
    addPlan({}, rows);
    measurePhase(task, specs, effort, rows, isTimeUp);
    return {{}, std::move(rows)};
}

std::unique_ptr<PhaseMethod> methodAtWork(const MethodPlan& plan, const TestBed& bed,
                                          const Subjects& subjects) {
    std::unique_ptr<PhaseMethod> method = makeMethod(plan, bed, subjects);
    method->hash(bed);
    method->run(bed);
    method->stand(bed);
    return method;
}

TEST(PaperPhases, FindWhatBruteForceFindsInEveryFrame) {
    for (const Phase phase : kPhases) {
        PaperReport report = reportOf({phase, kFew, 3, 12}, figureMethods(kFew), kBrief);
        EXPECT_EQ(
            asked(report.measured, "SELECT count(*), side, triangles FROM runs GROUP BY side"),
            "12 400 3,200");
        EXPECT_EQ(asked(report.measured,
                        "SELECT DISTINCT frames, checked_frames, checked_timed_frames,"
                        "                checked_objects, wrong_frames FROM measurements"),
                  "6 7 6 " + valueText(7.0 * kFew) + " 0");
        EXPECT_EQ(asked(report.measured, "SELECT min(found) > 50, max(fault) FROM checks"), "1 -");
    }
}

TEST(PaperPhases, AreComparedForSomeObjectsWhereThereAreMany) {
    const TestBed bed(kFew, 5);
    const Subjects some = Subjects::drawn(kFew, 40, 7);
    EXPECT_FALSE(some.areAll());
    EXPECT_GT(some.list().size(), 30U);
    for (const Phase phase : kPhases) {
        const PhaseAnswer right =
            methodAtWork({phase, MethodKind::unoptimized, 0, 12}, bed, some)->answer();
        PhaseAnswer answer =
            methodAtWork({phase, MethodKind::hashphase, 0, 12}, bed, Subjects::all(kFew))->answer();
        EXPECT_EQ(faultOf(phase, answer, right, some), std::nullopt);
        answer.found.clear();
        EXPECT_NE(faultOf(phase, answer, right, some), std::nullopt);
    }
}

TEST(PaperPhases, AreComparedByWhatIsMissingOrExtraAndByHeightsAndSpeeds) {
    const PhaseAnswer right{{5, 7}, {1, 2, 3, 4}};
    const std::string differs = "1 of 4 heights and speeds differ";
    for (const auto& [phase, answer, fault] :
         {std::tuple(Phase::collision, PhaseAnswer{{5, 7}, {1, 2, 3, 4.0001F}}, std::string("-")),
          {Phase::collision, {{5, 7}, {1.5F, 2, 3, 4}}, differs},
          {Phase::collision, {{5, 7}, {1, 2, 3}}, differs},
          {Phase::visibility, {{6, 7, 8}, {}}, "1 of 2 are missing, 2 are extra"},
          {Phase::ai, {{5}, {}}, "1 of 2 colours differ"},
          {Phase::ai, {{5, 7, 8}, {}}, "1 of 2 colours differ"}}) {
        EXPECT_EQ(faultOf(phase, answer, right, Subjects::all(1)).value_or("-"), fault);
    }
}

TEST(PaperPhases, FailTheRunWhenAMethodIsBroken) {
    for (const Phase phase : kPhases) {
        std::vector<MethodSpec> specs = figureMethods(kFew);
        specs.back() = forgetful(specs.back());
        PaperReport report = reportOf({phase, kFew, 3, 12}, specs, kBrief);
        EXPECT_EQ(asked(report.measured,
                        "SELECT run, count(fault) FROM checks "
                        "WHERE fault IS NOT NULL GROUP BY run"),
                  "12 7");
        EXPECT_EQ(report.findings.holds, false);
        EXPECT_EQ(exitCodeOf(report), kExitCheckFailed);
        const Check& check = report.findings.sections.at(0).checks.at(0);
        EXPECT_FALSE(check.holds);
        EXPECT_TRUE(holds(check.evidence, "of 1,500, hashphase, automatic cells: 1 of "))
            << check.evidence;
        EXPECT_TRUE(holds(report.findings.verdict, "NO, see above"));
    }
}

TEST(PaperPhases, CatchWhatGoesWrongInALateFrameOfAQuickRun) {
    for (const Phase phase : kPhases) {
        for (const bool isHurried : {false, true}) {
            PhaseEffort effort = quickEffort();
            effort.isHurried = isHurried;
            PaperReport report =
                reportOf({phase, 900, 3, 12},
                         std::array{forgetful({MethodKind::hashphase, std::nullopt}, 5),
                                    MethodSpec{MethodKind::paperGrid, 10}},
                         effort);
            EXPECT_EQ(asked(report.measured,
                            "SELECT frames, checked_frames, checked_timed_frames, "
                            "wrong_frames FROM measurements"),
                      isHurried ? "6 1 1 1; 6 1 1 0" : "6 2 1 1; 6 2 1 0");
            EXPECT_EQ(report.findings.holds, false);
        }
    }
}

TEST(PaperPhases, TellHowManyTimedFramesAreChecked) {
    const PaperReport report =
        reportOf({Phase::ai, 300, 3, 12}, std::array{MethodSpec{}}, quickEffort());
    EXPECT_EQ(report.findings.sections.at(0).checks.at(0).evidence,
              "1 of 6 timed frames checked, and 1 untimed");
    EXPECT_EQ(exitCodeOf(report), kExitOk);
}

TEST(PaperPhases, AreNotCheckedAndHoldNoBytesWhereNoFrameWasMeasured) {
    Measurements rows;
    addPlan({}, rows);
    measurePhase({Phase::collision, 300}, figureMethods(300), kBrief, rows, [] { return true; });
    rows.add("volume_checks", {{"volume", "sphere"}, {"pairs", 7}, {"is_right", true}});
    PaperReport report({}, std::move(rows));
    EXPECT_EQ(
        asked(report.measured, "SELECT count(*), sum(frames), count(bytes) FROM measurements"),
        "12 0 0");
    EXPECT_EQ(report.findings.holds, std::nullopt);
    EXPECT_EQ(exitCodeOf(report), kExitCheckFailed);
    EXPECT_TRUE(holds(report.findings.verdict, "brute force: not checked"));
    // What was not compared is no check.
    ASSERT_EQ(report.findings.sections.at(0).checks.size(), 1U);
    EXPECT_EQ(report.findings.sections[0].checks[0].evidence, "7 pairs touch");
}

TEST(PaperPhases, CountThePairsAndTheNumbersOfProxiesThatTheyKeep) {
    const TestBed bed(kFew, 5);
    const Subjects all = Subjects::all(kFew);
    for (const MethodKind kind : {MethodKind::unoptimized, MethodKind::paperGrid}) {
        const MethodPlan plan{Phase::collision, kind, 10, 12};
        const auto hashed = makeMethod(plan, bed, all);
        hashed->hash(bed);
        const auto method = methodAtWork(plan, bed, all);
        const std::size_t pairs = method->answer().found.size();
        EXPECT_GT(pairs, 50U);
        constexpr std::size_t kState = sizeof(float) + sizeof(Vector3<float>);
        EXPECT_GE(method->memoryBytes(),
                  hashed->memoryBytes() + pairs * sizeof(std::uint64_t) + kFew * kState);
    }
    Grid<float> grid({.cellSize = 10});
    grid.reserve(bed.objects());
    for (const Aabb<float>& box : bed.boxes()) {
        static_cast<void>(grid.add(box));
    }
    const auto culling = makeMethod({Phase::visibility, MethodKind::hashphase, 10, 12}, bed, all);
    EXPECT_GE(culling->memoryBytes(), grid.memoryBytes() + kFew * sizeof(ProxyId));
}

/// Of frames that four methods have run.
std::string askedOfTurns(std::uint64_t seed, bool isHurried, std::string_view sql) {
    PhaseEffort effort = kBrief;
    effort.isHurried = isHurried;
    PaperReport report =
        reportOf({Phase::visibility, 10, seed, 12}, std::vector<MethodSpec>(4), effort);
    return asked(report.measured, sql);
}

TEST(PaperPhases, TakeTurnsInAnOrderThatIsDrawnAnewInEachFrame) {
    constexpr const char* turns = "SELECT group_concat(run) FROM frames";
    const std::string drawn = askedOfTurns(3, false, turns);
    EXPECT_EQ(drawn, askedOfTurns(3, false, turns));
    EXPECT_NE(drawn, askedOfTurns(4, false, turns));
    EXPECT_EQ(askedOfTurns(3, true, turns), "1,2,3,4,1,2,3,4,1,2,3,4,1,2,3,4,1,2,3,4,1,2,3,4");
    EXPECT_EQ(askedOfTurns(3, false,
                           "SELECT DISTINCT count(DISTINCT run) FROM frames "
                           "GROUP BY (rowid - 1) / 4"),
              "4");
    EXPECT_EQ(askedOfTurns(3, false,
                           "SELECT count(DISTINCT next.run) > 1 FROM frames JOIN frames AS next "
                           "ON next.rowid = frames.rowid + 1 "
                           "WHERE frames.run = 1 AND frames.rowid % 4 > 0"),
              "1");
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
    PaperReport report(plan, measurePaper(plan, watch));
    ASSERT_GT(steps.size(), 18U);
    EXPECT_EQ(steps[0], "collision of 100, hashphase");
    EXPECT_EQ(steps[5], "AI of 200, hashphase");
    EXPECT_EQ(steps[6], "collision of 100, paper's grid");
    EXPECT_EQ(steps[17], "AI of 200, un-optimized");
    // The rounds of a figure stand together, and all of them are checked.
    EXPECT_EQ(asked(report.measured,
                    "SELECT phase, objects, count(*) FROM (SELECT * FROM measurements LIMIT 11)"),
              "collision 100 11");
    EXPECT_EQ(asked(report.measured,
                    "SELECT count(*), min(frames) > 0, min(checked_timed_frames) > 0 "
                    "FROM measurements"),
              "66 1 1");
    EXPECT_EQ(report.findings.holds, true);
    EXPECT_EQ(asked(report.measured, "SELECT what FROM all_left_out LIMIT 1"),
              "collision of 100, un-optimized");
}

TEST(BoundingVolumes, StopWhenTheTimeIsUpOrTheEffortIsSpent) {
    Measurements none;
    measureVolumes(200, kBrief, 1, none, [] { return true; });
    EXPECT_EQ(asked(none, "SELECT count(*), sum(is_right) FROM volume_checks"), "3 3");
    EXPECT_THROW(static_cast<void>(none.ask("SELECT * FROM volumes")), std::logic_error);
    int left = 3;
    Measurements some;
    measureVolumes(200, kBrief, 1, some, [&] { return left-- == 0; });
    EXPECT_EQ(asked(some, "SELECT count(*), count(DISTINCT frame) FROM volumes"), "9 3");
    Measurements few;
    measureVolumes(200, {.frames = 6, .fewestFrames = 2, .methodMilliseconds = 0}, 1, few);
    EXPECT_EQ(asked(few, "SELECT count(*), count(DISTINCT frame) FROM volumes"), "6 2");
}

TEST(BoundingVolumes, PassAllThatTouchAndFewerTheBetterTheyFit) {
    Measurements rows;
    measureVolumes(1'000, {.frames = 2, .fewestFrames = 2}, 1, rows);
    EXPECT_EQ(asked(rows,
                    "SELECT group_concat(volume), sum(is_right), min(pairs) > 25 "
                    "FROM volume_checks"),
              "sphere,AABB,OBB 3 1");
    EXPECT_EQ(asked(rows,
                    "SELECT group_concat(volume) FROM (SELECT * FROM volumes "
                    "GROUP BY volume ORDER BY sum(passed) DESC)"),
              "sphere,AABB,OBB");
    EXPECT_EQ(asked(rows,
                    "SELECT count(DISTINCT touching), min(touching) > 25, "
                    "min(passed >= touching) FROM volumes GROUP BY frame"),
              "1 1 1; 1 1 1");
}

Typed runPaperCommand(const std::vector<std::string>& arguments) {
    return typed(paperCommand(), arguments);
}

TEST(PaperCommand, WritesTheFiguresAsTextJsonCsvAndPage) {
    const TemporaryFolder folder;
    const std::string json = folder.file("paper.json");
    const std::string csv = folder.file("paper.csv");
    const std::string html = folder.file("paper.html");
    const Typed output = runPaperCommand({"--quick", "--objects", "500,1000", "--frames", "2",
                                          "--json", json, "--csv", csv, "--html", html, "--quiet"});
    EXPECT_EQ(output.exitCode, kExitOk) << output.out << output.err;
    EXPECT_EQ(output.err, "");
    EXPECT_TRUE(holds(output.out, "Figure 15, AI: frames a second"));
    EXPECT_TRUE(holds(output.out, "the same as brute force: yes\n"));
    const Json read = Json::parse(readFile(json));
    for (const auto& [pointer, value] : {std::pair<const char*, Json>{"/schema", "hashphase-paper"},
                                         {"/schemaVersion", 1},
                                         {"/checks/0/holds", true},
                                         {"/measurements/0/figure", 13},
                                         {"/measurements/0/objects", 500},
                                         {"/measurements/0/paper", "60+"},
                                         {"/measurements/0/cell_m", nullptr},
                                         {"/measurements/0/wrong_frames", 0},
                                         {"/measurements/0/side_m", 400},
                                         {"/measurements/0/triangles", 3'200}}) {
        EXPECT_EQ(read.at(Json::json_pointer(pointer)), value) << pointer;
    }
    const Json& first = read["measurements"][0];
    EXPECT_GT(first["frame_ms"].get<double>(), 0);
    EXPECT_GT(first["ground_ms"].get<double>(), 0);
    EXPECT_GE(first["checked_timed_frames"], 2);
    EXPECT_TRUE(read["realTime"]["AI"]["grid"].contains("paperToday"));
    EXPECT_EQ(read["neighboursByRadius"].size(), 5U);
    EXPECT_EQ(read["boundingVolumes"].size(), 3U);
    EXPECT_TRUE(readFile(csv).starts_with("part,figure,phase,objects,method,cell_m,"));
    EXPECT_TRUE(holds(readFile(html), "<td class=\"number good\">60+</td>"));
}

TEST(PaperCommand, LeavesOutWhatTheTimeLimitDoesNotAllowAndClaimsNothing) {
    const TemporaryFolder folder;
    const std::string json = folder.file("paper.json");
    const Typed output = runPaperCommand({"--time-limit", "1e-9", "--json", json, "--quiet"});
    EXPECT_EQ(output.exitCode, kExitCheckFailed) << output.err;
    EXPECT_TRUE(holds(output.out, "Left out: collision of 50,000, hashphase\n"));
    EXPECT_TRUE(holds(output.out, "the same as brute force: not checked\n"));
    const Json read = Json::parse(readFile(json));
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
        const Typed output = runPaperCommand(arguments);
        EXPECT_EQ(output.exitCode, kExitUsage) << arguments[0] << ' ' << arguments[1];
        EXPECT_NE(output.err, "");
    }
}

}  // namespace
}  // namespace hashphase::demos
