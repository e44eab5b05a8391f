// SPDX-License-Identifier: Zlib

// The filling of the broadphases that are compared: how long it takes, and what becomes of one that
// takes too long.

#include <demos/compare/compare_command.hpp>
#include <demos/compare/world_trial.hpp>
#include <demos/report/stopwatch.hpp>
#include <tests/demos/typed.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <chrono>
#include <sstream>
#include <thread>

namespace hashphase::demos {
namespace {

Typed compareOnTerminal(const std::vector<std::string>& arguments,
                        std::span<const BroadphaseKind> kinds) {
    return typed(arguments, std::array{compareCommand(kinds)}, true);
}

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

BroadphaseKind slowKind(bool ours) {
    return {"slow",
            "a slow one",
            "for tests",
            ours,
            1'000'000,
            true,
            [](const BroadphaseNeeds& needs) -> std::unique_ptr<btBroadphaseInterface> {
                return std::make_unique<SlowToFill>(static_cast<int>(needs.objects) + 1);
            }};
}

class CompareSlowToFill : public testing::TestWithParam<const char*> {};

// 4,000 objects take it 4 seconds at least; of the 4 that there are it may have one.
TEST_P(CompareSlowToFill, IsLeftOutAndTheOthersAreCompared) {
    const TemporaryFolder folder;
    const std::array kinds{slowKind(false), broadphaseKinds()[0]};
    const std::string json = folder.file("r.json");
    const std::string html = folder.file("r.html");
    const Typed outcome = compareOnTerminal(
        {"compare", "--scene", GetParam(), "--objects", "4000", "--frames", "1", "--time-limit",
         "4", "--json", json, "--html", html, "--csv", folder.file("r.csv")},
        kinds);
    EXPECT_EQ(outcome.exitCode, kExitOk) << outcome.out << outcome.err;
    EXPECT_NE(outcome.out.find("\nslow: left out, filling 4,00"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("every frame: yes"), std::string::npos) << outcome.out;
    const auto report = nlohmann::json::parse(std::ifstream(json));
    EXPECT_TRUE(report["broadphases"][0]["fillMs"].is_null());
    EXPECT_GT(report["broadphases"][0]["leftOutAfterSeconds"], 0);
    EXPECT_TRUE(report["broadphases"][0]["frames"].empty());
    EXPECT_GT(report["broadphases"][1]["fillMs"], 0);
    EXPECT_EQ(report["broadphases"][1]["frames"].size(), 1U);
    std::ostringstream page;
    page << std::ifstream(html).rdbuf();
    EXPECT_NE(page.str().find("slow: left out, filling 4,00"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(BoxesAndWorlds, CompareSlowToFill, testing::Values("uniform", "pile"));

TEST(Compare, FailsWhenOursIsNotFilledInTime) {
    const std::array kinds{slowKind(true), broadphaseKinds()[1]};
    const Typed outcome = compareOnTerminal(
        {"compare", "--objects", "2000", "--frames", "1", "--time-limit", "2"}, kinds);
    EXPECT_EQ(outcome.exitCode, kExitCheckFailed) << outcome.out;
    EXPECT_NE(outcome.out.find("none of ours took part"), std::string::npos) << outcome.out;
}

TEST(Compare, TellsHowLongTheBroadphaseTakesToBeFilledAndNotHowLongTheWorldDoes) {
    WorldTrial trial(
        [](WorldContents& contents) {
            auto& ball = contents.addShape<btSphereShape>(btScalar(1));
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
            contents.addBody(ball, 1, btVector3(0, 0, 0));
        },
        ReferenceMethod::kSweep);
    const Stopwatch watch;
    const std::optional<double> filled =
        trial.add(broadphaseKinds()[0], [](std::size_t) { return true; });
    ASSERT_TRUE(filled.has_value());
    EXPECT_GT(*filled, 0);
    EXPECT_LE(*filled, watch.milliseconds() - 50);
}

TEST(Compare, SaysFromTheBeginningWhatIsBeingDone) {
    const Typed outcome = compareOnTerminal(
        {"compare", "--objects", "300", "--frames", "4", "--broadphases", "hash,dbvt"},
        broadphaseKinds());
    for (const char* said : {"filling hash: 0 of 300", "filling dbvt: 0 of 300",
                             "frame: 1 of 4, exact pairs", "removing from dbvt: 0 of 150"}) {
        EXPECT_NE(outcome.err.find(said), std::string::npos) << said << " in " << outcome.err;
    }
}

}  // namespace
}  // namespace hashphase::demos
