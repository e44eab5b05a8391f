// SPDX-License-Identifier: Zlib
#include <demos/compare/compare_command.hpp>
#include <demos/compare/report.hpp>
#include <demos/compare/trial.hpp>
#include <demos/report/profile_zones.hpp>
#include <tests/demos/bullet_file.hpp>
#include <tests/demos/typed.hpp>
#include <tests/support/temporary_folder.hpp>

#include <LinearMath/btQuickprof.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <chrono>
#include <fstream>
#include <map>
#include <stdexcept>
#include <thread>

namespace hashphase::demos {
namespace {

// --- Bullet's zones -------------------------------------------------------------------------------

void solveRow(std::chrono::milliseconds duration) {
    BT_PROFILE("row");
    std::this_thread::sleep_for(duration);
}

TEST(ProfileZones, FollowTheZoneThatTheyAreWithin) {
    const std::vector<ProfileZone> zones = profileZonesOf([] {
        BT_PROFILE("step");
        for (int i = 0; i < 3; ++i) {
            BT_PROFILE("solve");
            solveRow(std::chrono::milliseconds(2));
        }
        solveRow(std::chrono::milliseconds(0));
    });
    ASSERT_EQ(zones.size(), 4U);
    const std::array<const char*, 4> names{"step", "solve", "row", "row"};
    const std::array depths{0, 1, 2, 1};
    const std::array calls{1U, 3U, 3U, 1U};
    for (std::size_t i = 0; i < zones.size(); ++i) {
        EXPECT_EQ(zones[i].name, names[i]);
        EXPECT_EQ(zones[i].depth, depths[i]) << names[i];
        EXPECT_EQ(zones[i].calls, calls[i]) << names[i];
    }
    EXPECT_GE(zones[2].milliseconds, 6);
    EXPECT_GE(zones[1].milliseconds, zones[2].milliseconds);
    EXPECT_GE(zones[0].milliseconds, zones[1].milliseconds + zones[3].milliseconds);
}

TEST(ProfileZones, GiveBulletsHooksBackHoweverTheStepEnds) {
    btEnterProfileZoneFunc* const enter = btGetCurrentEnterProfileZoneFunc();
    btLeaveProfileZoneFunc* const leave = btGetCurrentLeaveProfileZoneFunc();
    EXPECT_TRUE(
        profileZonesOf([&] { EXPECT_NE(btGetCurrentEnterProfileZoneFunc(), enter); }).empty());
    EXPECT_EQ(btGetCurrentEnterProfileZoneFunc(), enter);
    EXPECT_EQ(btGetCurrentLeaveProfileZoneFunc(), leave);
    EXPECT_THROW(static_cast<void>(profileZonesOf([] {
                     BT_PROFILE("step");
                     throw std::runtime_error("a callback's");
                 })),
                 std::runtime_error);
    EXPECT_EQ(btGetCurrentEnterProfileZoneFunc(), enter);
    EXPECT_EQ(btGetCurrentLeaveProfileZoneFunc(), leave);
}

// --- Worlds ---------------------------------------------------------------------------------------

TEST(ProfiledTrial, TakesTheStepsOfTheComparedOneAgain) {
    std::vector<const btRigidBody*> fallen;
    const auto fill = [&fallen](WorldContents& contents) {
        auto& box = contents.addShape<btBoxShape>(btVector3(0.5F, 0.5F, 0.5F));
        contents.addBody(box, 0, btVector3(0, 0, 0));
        for (int i = 1; i < 20; ++i) {
            const auto place = static_cast<btScalar>(i);
            fallen.push_back(&contents.addBody(box, 1, btVector3(0.03F * place, 1.2F * place, 0)));
        }
    };
    for (const BroadphaseKind& kind : broadphaseKinds()) {
        const auto always = [](std::size_t) { return true; };
        const std::unique_ptr<Trial> compared = worldTrial(fill, ReferenceMethod::kSweep);
        const std::unique_ptr<Trial> profiled = compared->profiled();
        fallen.clear();
        ASSERT_TRUE(compared->add(kind, always).has_value());
        ASSERT_TRUE(profiled->add(kind, always).has_value());
        ASSERT_EQ(fallen.size(), 38U);
        for (int frame = 0; frame < 90; ++frame) {
            static_cast<void>(compared->runFrame(0));
            const Observation seen = profiled->runFrame(0);
            EXPECT_TRUE(seen.reported.empty());
            EXPECT_GT(seen.shapeBoxesMs, 0);
            double outermost = 0;
            for (const ProfileZone& zone : seen.zones) {
                outermost += zone.depth == 0 ? zone.milliseconds : 0;
            }
            EXPECT_GT(outermost, seen.calculateMs);
        }
        for (std::size_t i = 0; i < 19; ++i) {
            EXPECT_EQ(fallen[i]->getWorldTransform(), fallen[i + 19]->getWorldTransform())
                << kind.name << ", body " << i;
        }
    }
}

nlohmann::json compared(const std::vector<std::string>& options) {
    const TemporaryFolder folder;
    const std::string file = folder.file("r.json");
    std::vector<std::string> arguments{"compare", "--json", file};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Typed outcome = typed(arguments, std::array{compareCommand(broadphaseKinds())});
    EXPECT_EQ(outcome.exitCode, kExitOk) << outcome.out << outcome.err;
    return nlohmann::json::parse(std::ifstream(file));
}

void expectPartsThatAddUp(const nlohmann::json& report, int steps) {
    ASSERT_FALSE(report["broadphases"].empty());
    for (const nlohmann::json& broadphase : report["broadphases"]) {
        const nlohmann::json& profiled = broadphase["profiled"];
        EXPECT_EQ(profiled["steps"], steps);
        std::map<std::string, double> parts;
        double sum = 0;
        double shares = 0;
        for (const nlohmann::json& part : broadphase["stepParts"]) {
            EXPECT_GE(part["ms"], 0) << part;
            EXPECT_FALSE(part["part"].get<std::string>().starts_with("hashphase")) << part;
            parts[part["part"]] = part["ms"];
            sum += part["ms"].get<double>();
            shares += part["share"].get<double>();
        }
        const double step = profiled["stepMs"];
        EXPECT_EQ(parts.size(), broadphase["stepParts"].size());
        for (const char* name :
             {"boxes of the shapes", "setAabb", "calculateOverlappingPairs",
              "dispatchAllCollisionPairs", "calculateSimulationIslands", "solveConstraints",
              "predictUnconstraintMotion", "integrateTransforms", "all else"}) {
            EXPECT_TRUE(parts.contains(name)) << name;
        }
        EXPECT_NEAR(sum, step, 1e-9 * step);
        EXPECT_NEAR(shares, 1, 1e-9);
        const double own = parts["setAabb"] + parts["calculateOverlappingPairs"];
        EXPECT_NEAR(profiled["broadphaseMs"], own, 1e-9 * step);
        EXPECT_NEAR(profiled["leftToGain"], own / step, 1e-9);
    }
}

class StepProfileScene : public testing::TestWithParam<const char*> {};

// Of 30 frames 7 warm up, and the fastest and the slowest one are set apart.
TEST_P(StepProfileScene, HasPartsThatAddUpToTheStep) {
    expectPartsThatAddUp(compared({"--scene", GetParam(), "--objects", "60", "--frames", "30"}),
                         21);
}

INSTANTIATE_TEST_SUITE_P(Worlds, StepProfileScene,
                         testing::Values("pile", "stack", "chains", "static-city", "bullet-storm"),
                         [](const auto& scene) {
                             std::string name(scene.param);
                             std::erase(name, '-');
                             return name;
                         });

#if HASHPHASE_HAS_BULLET_IMPORTER
TEST(StepProfile, HasPartsThatAddUpInAWorldFromAFile) {
    const TemporaryFolder folder;
    const std::string path = folder.write("w.bullet", serialisedWorld(6));
    expectPartsThatAddUp(compared({"--file", path, "--frames", "12"}), 9);
}
#endif

TEST(StepProfile, IsOnThePageAndNotWhereThereIsNoStep) {
    const TemporaryFolder folder;
    const auto pageOfScene = [&folder](const std::string& scene) {
        const std::string path = folder.file(scene + ".html");
        const Typed outcome =
            typed({"compare", "--scene", scene, "--objects", "40", "--frames", "8", "--broadphases",
                   "hash,dbvt", "--verbose", "--html", path},
                  std::array{compareCommand(broadphaseKinds())});
        EXPECT_EQ(outcome.exitCode, kExitOk) << outcome.err;
        return std::pair(outcome.out, readFile(path));
    };
    const auto [text, page] = pageOfScene("stack");
    for (const char* part : {"\nhash: broadphase ", "\ndbvt: broadphase ", "left to gain: ",
                             "\npart of a step ", "\nsolveConstraints ", "\nwhole step "}) {
        EXPECT_TRUE(holds(text, part));
    }
    EXPECT_TRUE(holds(page, "Where does the time of a step go?</h2>"));
    EXPECT_TRUE(holds(page, "id=\"compare-steps\""));
    const auto [boxesText, boxesPage] = pageOfScene("uniform");
    EXPECT_FALSE(holds(boxesText, "left to gain"));
    EXPECT_FALSE(holds(boxesText, "part of a step"));
    EXPECT_FALSE(holds(boxesPage, "Where does the time of a step go?"));
    EXPECT_FALSE(holds(boxesPage, "id=\"compare-steps\""));
}

// --- What is made of them -------------------------------------------------------------------------

constexpr const char* kStep = "internalSingleStepSimulation";

// A run of the hash whose one frame was timed.
Measurements measuredRun() {
    Measurements measured;
    measured.add("run", {{"scene", "s"},
                         {"description", "d"},
                         {"noun", "bodies"},
                         {"from_file", 0},
                         {"objects", 2},
                         {"frames_asked", 1},
                         {"warm_up", 0},
                         {"frames_done", 1},
                         {"removed", 1},
                         {"seed", 1},
                         {"reference", "sweep"},
                         {"time_limit", {}},
                         {"interrupted", 0},
                         {"stopped", {}}});
    measured.add("broadphases", {{"name", "hash"},
                                 {"title", "hashphase"},
                                 {"ours", 1},
                                 {"fill_ms", 1},
                                 {"left_out_after", {}},
                                 {"remove_ms", {}},
                                 {"memory", {}}});
    measured.add("frames", {{"name", "hash"},
                            {"frame", 0},
                            {"measured", 1},
                            {"pairs", 1},
                            {"exact_pairs", 1},
                            {"missing", 0},
                            {"extra", 0},
                            {"stale", 0},
                            {"set_aabb_ms", 1},
                            {"calculate_ms", 1},
                            {"step_ms", 10}});
    return measured;
}

void addStep(Measurements& measured, int frame, double milliseconds, double shapeBoxes) {
    measured.add("steps", {{"name", "hash"},
                           {"frame", frame},
                           {"step_ms", milliseconds},
                           {"shape_boxes_ms", shapeBoxes}});
}

void addZone(Measurements& measured, int frame, const char* within, const char* zone, double ms) {
    measured.add(
        "zones",
        {{"name", "hash"}, {"frame", frame}, {"within", within}, {"zone", zone}, {"ms", ms}});
}

std::vector<std::pair<std::string, std::string>> cellsOf(const Findings& findings) {
    std::vector<std::pair<std::string, std::string>> cells;
    for (const std::vector<Value>& row : findings.rows.at("step table").rows) {
        cells.emplace_back(valueText(row.at(0)), valueText(row.at(1)));
    }
    return cells;
}

// Of 8 ms in the step 1 is in no part, and 2 more are outside of all zones. Zones within a part count once, as it.
TEST(StepReport, TellsThePartsTheRestAndWhatIsLeftToGain) {
    Measurements measured = measuredRun();
    addStep(measured, 0, 10, 0.5);
    addZone(measured, 0, "", kStep, 8);
    addZone(measured, 0, kStep, "performDiscreteCollisionDetection", 4);
    addZone(measured, 0, "performDiscreteCollisionDetection", "updateAabbs", 1.5);
    addZone(measured, 0, "performDiscreteCollisionDetection", "calculateOverlappingPairs", 1);
    addZone(measured, 0, "updateAabbs", "hashphase: set boxes", 0.75);
    addZone(measured, 0, "calculateOverlappingPairs", "hashphase: update pairs", 0.5);
    addZone(measured, 0, "calculateOverlappingPairs", "hashphase: pair cache", 0.25);
    addZone(measured, 0, "performDiscreteCollisionDetection", "dispatchAllCollisionPairs", 1.5);
    addZone(measured, 0, "dispatchAllCollisionPairs", "processAllOverlappingPairs", 1.25);
    addZone(measured, 0, kStep, "solveConstraints", 3);
    addZone(measured, 0, "solveConstraints", "solveGroup", 2);
    const Findings findings = compareFindings(measured);
    EXPECT_EQ(cellsOf(findings), (std::vector<std::pair<std::string, std::string>>{
                                     {"boxes of the shapes", "0.500 (5.0 %)"},
                                     {"setAabb", "1.00 (10.0 %)"},
                                     {"calculateOverlappingPairs", "1.00 (10.0 %)"},
                                     {"dispatchAllCollisionPairs", "1.50 (15.0 %)"},
                                     {"solveConstraints", "3.00 (30.0 %)"},
                                     {"all else", "3.00 (30.0 %)"},
                                     {"whole step", "10.0"}}));
    EXPECT_EQ(sentencesOf(findings.rows.at("step sentences")).back(),
              "hash: broadphase 2.00 of 10.0 ms; left to gain: 20.0 %.");
}

TEST(StepReport, SetsAsideTheFastestAndTheSlowestTwentiethOfTheSteps) {
    Measurements measured = measuredRun();
    for (int frame = 0; frame < 20; ++frame) {
        const double length = frame == 3 ? 1000 : frame == 8 ? 1 : 10;
        addStep(measured, frame, length, 0.25);
        addZone(measured, frame, kStep, "updateAabbs", length / 4);
        addZone(measured, frame, kStep, "calculateOverlappingPairs", length / 2);
    }
    const Findings findings = compareFindings(measured);
    EXPECT_EQ(cellsOf(findings), (std::vector<std::pair<std::string, std::string>>{
                                     {"boxes of the shapes", "0.250 (2.5 %)"},
                                     {"setAabb", "2.25 (22.5 %)"},
                                     {"calculateOverlappingPairs", "5.00 (50.0 %)"},
                                     {"all else", "2.50 (25.0 %)"},
                                     {"whole step", "10.0"}}));
}

TEST(StepReport, SaysThatBulletHasNoZonesAndShowsNoTable) {
    Measurements measured = measuredRun();
    addStep(measured, 0, 10, 0.5);
    const Findings findings = compareFindings(measured);
    EXPECT_TRUE(cellsOf(findings).empty());
    EXPECT_EQ(sentencesOf(findings.rows.at("step sentences")),
              std::vector<std::string>{"This Bullet was built without profile zones: the cost of "
                                       "the other parts of a step is unknown."});
}

TEST(StepReport, SaysThatNoTimeWasLeft) {
    Measurements measured = measuredRun();
    const Findings findings = compareFindings(measured);
    EXPECT_TRUE(cellsOf(findings).empty());
    EXPECT_EQ(sentencesOf(findings.rows.at("step sentences")),
              std::vector<std::string>{"No time was left to measure the other parts of a step."});
}

}  // namespace
}  // namespace hashphase::demos
