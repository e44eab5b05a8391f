// SPDX-License-Identifier: Zlib
#include <demos/compare/compare_command.hpp>
#include <demos/compare/trial.hpp>
#include <demos/report/stopwatch.hpp>
#include <tests/demos/bullet_file.hpp>
#include <tests/demos/spoiled_broadphase.hpp>
#include <tests/demos/typed.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <chrono>
#include <thread>

namespace hashphase::demos {
namespace {

Typed runCompare(const std::vector<std::string>& arguments,
                 std::span<const BroadphaseKind> kinds = broadphaseKinds()) {
    return typed(arguments, std::array{compareCommand(kinds)});
}

class MissesOnePair : public SpoiledBroadphase {
    using SpoiledBroadphase::SpoiledBroadphase;
    void spoil(btDispatcher* dispatcher) override {
        getOverlappingPairCache()->removeOverlappingPair(proxies_[0], proxies_[1], dispatcher);
    }
};

class InventsOnePair : public SpoiledBroadphase {
    using SpoiledBroadphase::SpoiledBroadphase;
    void spoil(btDispatcher* /*dispatcher*/) override {
        getOverlappingPairCache()->addOverlappingPair(proxies_[0], proxies_[2]);
    }
};

// Takes a millisecond for each object, and more on a slow machine.
class SlowToFill : public btSimpleBroadphase {
public:
    using btSimpleBroadphase::btSimpleBroadphase;

    btBroadphaseProxy* createProxy(const btVector3& low, const btVector3& high, int shapeType,
                                   void* client, int group, int mask,
                                   btDispatcher* dispatcher) override {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return btSimpleBroadphase::createProxy(low, high, shapeType, client, group, mask,
                                               dispatcher);
    }
};

template <class Kind>
BroadphaseKind kindOf(bool ours, std::string_view name = "broken") {
    return {name,
            "one for tests",
            "for tests",
            ours,
            1'000'000,
            true,
            [](const BroadphaseNeeds& needs) -> std::unique_ptr<btBroadphaseInterface> {
                return std::make_unique<Kind>(static_cast<int>(needs.objects) + 1);
            }};
}

// Boxes 0 and 1 overlap deeply in every frame, box 2 is far from both.
const std::string kThreeBoxes = "0 0 0 1 1 1\n0 0 0 1 1 1.1\n50 50 50 51 51 51\n";

TEST(Compare, EndsWithAVerdictThatTheSetsAreExact) {
    const Typed outcome = runCompare({"compare", "--objects", "300", "--frames", "12"});
    EXPECT_EQ(outcome.exitCode, kExitOk) << outcome.out << outcome.err;
    const std::size_t lastLine = outcome.out.rfind('\n', outcome.out.size() - 2) + 1;
    const std::string verdict = outcome.out.substr(lastLine);
    EXPECT_TRUE(verdict.starts_with("300 spheres, 12 frames: hashphase ")) << verdict;
    EXPECT_NE(verdict.find("; pair sets exact in every frame: yes\n"), std::string::npos);
    for (const char* name :
         {"\nhash ", "\ndbvt ", "\ndbvt-deferred ", "\naxis-sweep ", "\nsimple "}) {
        EXPECT_TRUE(holds(outcome.out, name));
    }
}

class CompareScene : public testing::TestWithParam<const char*> {};

TEST_P(CompareScene, IsExactByEitherReference) {
    for (const char* reference : {"sweep", "brute"}) {
        const Typed outcome = runCompare({"compare", "--scene", GetParam(), "--objects", "150",
                                          "--frames", "30", "--reference", reference});
        EXPECT_EQ(outcome.exitCode, kExitOk) << outcome.out << outcome.err;
        EXPECT_TRUE(holds(outcome.out, "every frame: yes"));
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, CompareScene,
                         testing::Values("paper", "uniform", "piles", "logsizes", "resting",
                                         "moving-5", "moving-2", "static-90", "terdiman",
                                         "brownian", "pile", "stack", "chains", "static-city"),
                         [](const auto& scene) {
                             std::string name(scene.param);
                             std::erase(name, '-');
                             return name;
                         });

TEST(Compare, FailsAndNamesTheFirstMissedPair) {
    const TemporaryFolder folder;
    const std::array kinds{kindOf<MissesOnePair>(true)};
    const Typed outcome = runCompare(
        {"compare", "--file", folder.write("b.txt", kThreeBoxes), "--frames", "6"}, kinds);
    EXPECT_EQ(outcome.exitCode, kExitCheckFailed);
    EXPECT_NE(outcome.out.find("pair sets exact in every frame: NO: 'broken' first missed the pair "
                               "0, 1 in frame 3; box 0 is ["),
              std::string::npos)
        << outcome.out;
}

TEST(Compare, FailsAndNamesTheFirstInventedPair) {
    const TemporaryFolder folder;
    const std::array kinds{kindOf<InventsOnePair>(true)};
    const std::string file = folder.file("r.json");
    const Typed outcome = runCompare(
        {"compare", "--file", folder.write("b.txt", kThreeBoxes), "--frames", "6", "--json", file},
        kinds);
    EXPECT_EQ(outcome.exitCode, kExitCheckFailed);
    EXPECT_TRUE(holds(outcome.out, "'broken' first falsely listed the pair 0, 2 in frame 3"));
    const auto report = nlohmann::json::parse(std::ifstream(file));
    EXPECT_EQ(report["verdict"]["exact"], false);
    EXPECT_EQ(report["broadphases"][0]["extra"]["total"], 3);
    EXPECT_EQ(report["broadphases"][0]["firstFault"]["kind"], "extra");
    EXPECT_EQ(report["broadphases"][0]["firstFault"]["objects"], nlohmann::json::array({0, 2}));
}

TEST(Compare, DoesNotFailForWhatOthersGetWrong) {
    const TemporaryFolder folder;
    const std::array kinds{kindOf<MissesOnePair>(false)};
    const Typed outcome = runCompare(
        {"compare", "--file", folder.write("b.txt", kThreeBoxes), "--frames", "6"}, kinds);
    EXPECT_EQ(outcome.exitCode, kExitOk);
    EXPECT_TRUE(holds(outcome.out, "no hashphase broadphase took part"));
}

TEST(Compare, ShowsTheStalePairsOfTheTree) {
    const TemporaryFolder folder;
    const std::string file = folder.file("r.json");
    runCompare({"compare", "--scene", "uniform", "--objects", "1000", "--frames", "30",
                "--broadphases", "dbvt", "--json", file});
    const auto report = nlohmann::json::parse(std::ifstream(file));
    EXPECT_EQ(report["broadphases"][0]["missing"]["total"], 0);
    EXPECT_GT(report["broadphases"][0]["stale"]["total"], 0);
    EXPECT_TRUE(report["verdict"]["exact"].is_null());
}

TEST(Compare, WritesJsonWithARowForEveryFrame) {
    const TemporaryFolder folder;
    const std::string path = folder.file("r.json");
    ASSERT_EQ(runCompare({"compare", "--scene", "uniform", "--objects", "100", "--frames", "8",
                          "--broadphases", "hash,dbvt", "--seed", "9", "--json", path})
                  .exitCode,
              kExitOk);
    const auto report = nlohmann::json::parse(std::ifstream(path));
    EXPECT_EQ(report["schema"], "hashphase-compare");
    EXPECT_EQ(report["schemaVersion"], 1);
    EXPECT_EQ(report["settings"]["seed"], 9);
    EXPECT_EQ(report["settings"]["objects"], 100);
    EXPECT_EQ(report["settings"]["warmUpFrames"], 2);
    EXPECT_EQ(report["provenance"]["precision"], "single");
    EXPECT_EQ(report["provenance"]["commandLine"], "hashphase test");
    ASSERT_EQ(report["broadphases"].size(), 2U);
    EXPECT_EQ(report["broadphases"][1]["name"], "dbvt");
    EXPECT_EQ(report["broadphases"][1]["speedAgainstDbvt"], 1.0);
    ASSERT_EQ(report["broadphases"][0]["frames"].size(), 8U);
    EXPECT_EQ(report["broadphases"][0]["frames"][7]["frame"], 7);
    EXPECT_TRUE(report["broadphases"][0]["frames"][7]["stepMs"].is_null());
}

TEST(Compare, ShowsEverySeedAsGiven) {
    const TemporaryFolder folder;
    const std::string path = folder.file("r.json");
    for (const std::uint64_t seed : {std::uint64_t{9'007'199'254'740'993}, ~std::uint64_t{0}}) {
        const Typed outcome = runCompare({"compare", "--objects", "9", "--frames", "1", "--seed",
                                          std::to_string(seed), "--json", path});
        EXPECT_TRUE(holds(outcome.out, ", seed " + std::to_string(seed) + "\n"));
        EXPECT_EQ(nlohmann::json::parse(std::ifstream(path))["settings"]["seed"], seed);
    }
}

TEST(Compare, CountsOnlyTheObjectsThatItHasRemoved) {
    const TemporaryFolder folder;
    const std::string path = folder.file("r.json");
    const auto removed = [&](const std::vector<std::string>& options) {
        std::vector<std::string> all{"compare", "--objects", "100", "--broadphases",
                                     "hash",    "--json",    path};
        all.insert(all.end(), options.begin(), options.end());
        runCompare(all);
        return nlohmann::json::parse(std::ifstream(path))["verdict"]["objectsRemoved"];
    };
    EXPECT_EQ(removed({"--frames", "1"}), 50);
    EXPECT_EQ(removed({"--frames", "1", "--scene", "pile"}), 0) << "of a world";
    EXPECT_EQ(removed({"--frames", "1000000", "--time-limit", "0.3"}), 0) << "no time was left";
}

TEST(Compare, WritesCsvWithALineForEveryFrameOfEveryBroadphase) {
    const TemporaryFolder folder;
    const std::string path = folder.file("r.csv");
    runCompare({"compare", "--scene", "stack", "--objects", "20", "--frames", "5", "--broadphases",
                "hash,simple", "--csv", path});
    std::ifstream file(path);
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);) {
        EXPECT_EQ(std::count(line.begin(), line.end(), ','), 10) << line;
        lines.push_back(line);
    }
    ASSERT_EQ(lines.size(), 11U);
    EXPECT_TRUE(lines[0].starts_with("broadphase,frame,"));
    EXPECT_TRUE(lines[6].starts_with("simple,0,"));
    EXPECT_NE(lines[6].back(), ',') << "a dynamics scene has step times";
}

TEST(Compare, RefusesResultFilesThatCannotBeWritten) {
    const TemporaryFolder folder;
    const std::string path = folder.file("none/r");
    for (const char* option : {"--json", "--csv", "--html"}) {
        const Typed outcome =
            runCompare({"compare", "--objects", "10", "--frames", "1", option, path});
        EXPECT_EQ(outcome.exitCode, kExitUsage);
        EXPECT_EQ(outcome.err,
                  "hashphase: " + path + " cannot be written: No such file or directory.\n");
        EXPECT_EQ(outcome.out, "");
    }
}

TEST(Compare, ReadsARecordingToItsEndAndNoFurther) {
    const TemporaryFolder folder;
    std::string bytes(304 + 3 * 32, '\0');
    bytes[256] = 1;  // object
    bytes[260] = 2;  // frames
    const std::string path = folder.write("r.aabbs", bytes);
    const Typed outcome = runCompare({"compare", "--file", path});
    EXPECT_EQ(outcome.exitCode, kExitOk) << outcome.err;
    EXPECT_TRUE(holds(outcome.out, "1 boxes, 3 frames"));
    EXPECT_EQ(runCompare({"compare", "--file", path, "--frames", "4"}).err,
              "hashphase: " + path + " holds 3 frames, but --frames asks for 4.\n");
    EXPECT_EQ(runCompare({"compare", "--file", path, "--seed", "7"}).err,
              "hashphase: --seed has no effect on " + path + "; leave it out.\n");
}

#if HASHPHASE_HAS_BULLET_IMPORTER
TEST(Compare, RunsAWorldFromAFileInEveryBroadphase) {
    const TemporaryFolder folder;
    const std::string path = folder.write("w.bullet", serialisedWorld(6));
    const Typed outcome = runCompare({"compare", "--file", path, "--frames", "20"});
    EXPECT_EQ(outcome.exitCode, kExitOk) << outcome.err;
    EXPECT_TRUE(holds(outcome.out, "6 bodies, 20 frames: "));
    const Typed capitals = runCompare(
        {"compare", "--file", folder.write("W.BULLET", serialisedWorld(6)), "--frames", "2"});
    EXPECT_TRUE(holds(capitals.out, "6 bodies, 2 frames: "));
    EXPECT_EQ(runCompare({"compare", "--file", path, "--objects", "3"}).exitCode, kExitUsage);
}
#endif

TEST(Compare, StopsAtTheTimeLimitAndSaysSo) {
    const Typed outcome = runCompare({"compare", "--objects", "100", "--frames", "1000000",
                                      "--time-limit", "1", "--broadphases", "hash"});
    EXPECT_EQ(outcome.exitCode, kExitOk);
    EXPECT_TRUE(holds(outcome.out, "The time limit of 1 s was reached after "));
}

TEST(Compare, ReportsNothingMeasuredWhenTheTimeLimitLeavesNoFrame) {
    const TemporaryFolder folder;
    const std::string file = folder.file("r.json");
    const Typed outcome = runCompare({"compare", "--objects", "2000", "--time-limit", "0.000001",
                                      "--broadphases", "hash,dbvt", "--json", file});
    EXPECT_EQ(outcome.exitCode, kExitCheckFailed) << "nothing was verified";
    EXPECT_TRUE(holds(outcome.out, "not verified: no frame was run"));
    const auto report = nlohmann::json::parse(std::ifstream(file));
    EXPECT_TRUE(report["broadphases"][0]["bothMs"].is_null());
    EXPECT_TRUE(report["verdict"]["exact"].is_null());
}

class CompareSlowToFill : public testing::TestWithParam<const char*> {};

// 4,000 objects take it 4 seconds at least; of the 4 that there are it may have one.
TEST_P(CompareSlowToFill, IsLeftOutAndTheOthersAreCompared) {
    const TemporaryFolder folder;
    const std::array kinds{kindOf<SlowToFill>(false, "slow"), broadphaseKinds()[0]};
    const std::string file = folder.file("r.json");
    const std::string html = folder.file("r.html");
    const Typed outcome = runCompare(
        {"compare", "--scene", GetParam(), "--objects", "4000", "--frames", "1", "--time-limit",
         "4", "--json", file, "--html", html, "--csv", folder.file("r.csv")},
        kinds);
    EXPECT_EQ(outcome.exitCode, kExitOk) << outcome.out << outcome.err;
    EXPECT_TRUE(holds(outcome.out, "\nslow: left out, creating 4,00"));
    EXPECT_TRUE(holds(outcome.out, "every frame: yes"));
    const auto report = nlohmann::json::parse(std::ifstream(file));
    EXPECT_TRUE(report["broadphases"][0]["fillMs"].is_null());
    EXPECT_GT(report["broadphases"][0]["leftOutAfterSeconds"], 0);
    EXPECT_TRUE(report["broadphases"][0]["frames"].empty());
    EXPECT_GT(report["broadphases"][1]["fillMs"], 0);
    EXPECT_EQ(report["broadphases"][1]["frames"].size(), 1U);
    EXPECT_TRUE(holds(readFile(html), "slow: left out, creating 4,00"));
}

INSTANTIATE_TEST_SUITE_P(BoxesAndWorlds, CompareSlowToFill, testing::Values("uniform", "pile"));

TEST(Compare, DoesNotBlameTheTimeLimitIfAllBroadphasesAreLeftOut) {
    const TemporaryFolder folder;
    const std::string file = folder.file("r.json");
    const std::array kinds{kindOf<SlowToFill>(true, "slow")};
    const Typed outcome =
        runCompare({"compare", "--objects", "4000", "--time-limit", "4", "--json", file}, kinds);
    EXPECT_EQ(outcome.exitCode, kExitCheckFailed) << outcome.out;
    EXPECT_TRUE(holds(outcome.out, "\nslow: left out, creating 4,000 "));
    EXPECT_FALSE(holds(outcome.out, "The time limit of"));
    EXPECT_EQ(nlohmann::json::parse(std::ifstream(file))["verdict"]["timeLimitHit"], false);
}

TEST(Compare, FailsWhenOursIsNotFilledInTime) {
    const std::array kinds{kindOf<SlowToFill>(true, "slow"), broadphaseKinds()[1]};
    const Typed outcome =
        runCompare({"compare", "--objects", "2000", "--frames", "1", "--time-limit", "2"}, kinds);
    EXPECT_EQ(outcome.exitCode, kExitCheckFailed) << outcome.out;
    EXPECT_TRUE(holds(outcome.out, "no hashphase broadphase took part"));
}

TEST(Compare, TellsHowLongTheBroadphaseTakesToBeFilledAndNotHowLongTheWorldDoes) {
    const std::unique_ptr<Trial> trial = worldTrial(
        [](WorldContents& contents) {
            auto& ball = contents.addShape<btSphereShape>(btScalar(1));
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
            contents.addBody(ball, 1, btVector3(0, 0, 0));
        },
        ReferenceMethod::kSweep);
    const Stopwatch watch;
    const std::optional<double> filled =
        trial->add(broadphaseKinds()[0], [](std::size_t) { return true; });
    ASSERT_TRUE(filled.has_value());
    EXPECT_GT(*filled, 0);
    EXPECT_LE(*filled, watch.milliseconds() - 50);
}

TEST(Compare, SaysFromTheBeginningWhatIsBeingDone) {
    const Typed outcome =
        typed({"compare", "--objects", "300", "--frames", "4", "--broadphases", "hash,dbvt"},
              std::array{compareCommand()}, true);
    for (const char* said : {"filling hash: 0 of 300", "filling dbvt: 0 of 300",
                             "frame: 1 of 4, exact pairs", "removing from dbvt: 0 of 150"}) {
        EXPECT_TRUE(holds(outcome.err, said));
    }
}

TEST(CommandLine, ListsScenesAndBroadphases) {
    const Typed outcome = runCompare({"compare", "--list"});
    EXPECT_EQ(outcome.exitCode, kExitOk);
    for (const char* name : {"paper ", "static-city ", "axis-sweep ", "hash "}) {
        EXPECT_TRUE(holds(outcome.out, std::string("\n  ") + name));
    }
    EXPECT_TRUE(holds(outcome.out, "400 x 400 m (30,000)\n"));
    EXPECT_TRUE(holds(outcome.out, "for every 40 of them (20,000)\n"));
}

TEST(CommandLine, ShowsHelpAndVersion) {
    EXPECT_EQ(runCompare({"--help"}).exitCode, kExitOk);
    EXPECT_TRUE(holds(runCompare({"--help"}).out, "compare"));
    EXPECT_TRUE(holds(runCompare({"compare", "--help"}).out, "--time-limit"));
    EXPECT_TRUE(runCompare({"--version"}).out.starts_with("hashphase "));
    EXPECT_EQ(runCompare({}).exitCode, kExitUsage);
}

TEST(CommandLine, SuggestsTheNearNameForEveryKindOfWord) {
    const auto errorOf = [](const std::vector<std::string>& arguments) {
        const Typed outcome = runCompare(arguments);
        EXPECT_EQ(outcome.exitCode, kExitUsage) << outcome.out;
        return outcome.err;
    };
    EXPECT_EQ(errorOf({"comprae"}),
              "hashphase: There is no subcommand 'comprae'; did you mean 'compare'?\n");
    EXPECT_EQ(errorOf({"compare", "--sceen", "paper"}),
              "hashphase: There is no option '--sceen'; did you mean '--scene'?\n");
    EXPECT_EQ(errorOf({"compare", "--scene", "papre"}),
              "hashphase: There is no scene 'papre'; did you mean 'paper'?\n");
    EXPECT_EQ(errorOf({"compare", "--broadphases", "hash,dbtv"}),
              "hashphase: There is no broadphase 'dbtv'; did you mean 'dbvt'?\n");
}

TEST(CommandLine, RefusesValuesOutOfRangeAndOptionsThatExcludeEachOther) {
    for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
             {"compare", "--list", "--objects", "0"},
             {"compare", "--list", "--objects", "-3"},
             {"compare", "--list", "--objects", "many"},
             {"compare", "--list", "--frames", "0"},
             {"compare", "--list", "--time-limit", "-1"},
             {"compare", "--list", "--time-limit", "nan"},
             {"compare", "--list", "--reference", "guess"},
             {"compare", "--list", "--scene"},
             {"compare", "--list", "--scene", "paper", "--file", "x.txt"},
             {"compare", "--list", "--seed", "-1"},
             {"compare", "--list", "stray"},
             {"compare", "--broadphases", ""},
             {"compare", "--file", "/nonexistent/x.txt"},
             {"compare", "--file", "/nonexistent/x.bullet"},
             {"compare", "--file", "/nonexistent/x.aabbs"}}) {
        const Typed outcome = runCompare(arguments);
        EXPECT_EQ(outcome.exitCode, kExitUsage) << testing::PrintToString(arguments) << outcome.out;
        EXPECT_TRUE(outcome.err.starts_with("hashphase: ")) << outcome.err;
    }
}

}  // namespace
}  // namespace hashphase::demos
