// SPDX-License-Identifier: Zlib
#include <demos/compare/compare_command.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cstdlib>
#include <sstream>

namespace hashphase::demos {
namespace {

/// Bullet's brute force, but for a pair that it forgets from the sixth frame on.
class Forgets : public btSimpleBroadphase {
public:
    using btSimpleBroadphase::btSimpleBroadphase;

    void calculateOverlappingPairs(btDispatcher* dispatcher) override {
        btSimpleBroadphase::calculateOverlappingPairs(dispatcher);
        btBroadphasePairArray& pairs = getOverlappingPairCache()->getOverlappingPairArray();
        if (++frames_ > 5 && pairs.size() > 0) {
            btBroadphaseProxy* const a = pairs[0].m_pProxy0;
            btBroadphaseProxy* const b = pairs[0].m_pProxy1;
            getOverlappingPairCache()->removeOverlappingPair(a, b, dispatcher);
        }
    }

private:
    int frames_ = 0;
};

constexpr std::size_t kForgetsFrom = 5;

std::array<BroadphaseKind, 2> kindsToReplay() {
    const auto make = [](const BroadphaseNeeds& needs) -> std::unique_ptr<btBroadphaseInterface> {
        return std::make_unique<btSimpleBroadphase>(static_cast<int>(needs.objects) + 1);
    };
    const auto makeForgetful =
        [](const BroadphaseNeeds& needs) -> std::unique_ptr<btBroadphaseInterface> {
        return std::make_unique<Forgets>(static_cast<int>(needs.objects) + 1);
    };
    return {BroadphaseKind{"right", "a right one", "for tests", false, 1'000'000, true, make},
            BroadphaseKind{"forgetful", "a wrong one", "for tests", false, 1'000'000, true,
                           makeForgetful}};
}

/// Writes the page, and returns what the comparison found of "forgetful" itself.
nlohmann::json comparePage(const TemporaryFolder& folder, std::vector<std::string> arguments,
                           const std::string& page) {
    std::ostringstream out;
    std::ostringstream err;
    const auto kinds = kindsToReplay();
    const std::array subcommands{compareCommand(kinds)};
    const std::string json = folder.file("comparison.json");
    arguments.insert(arguments.begin(), "compare");
    arguments.insert(arguments.end(), {"--html", page, "--json", json});
    EXPECT_EQ(runProgram(arguments, subcommands, {out, err, false, "hashphase test"}), kExitOk)
        << err.str();
    return nlohmann::json::parse(std::ifstream(json))["broadphases"][1];
}

nlohmann::json browseReplays(const TemporaryFolder& folder, const std::vector<std::string>& pages) {
    std::string command =
        "'" HASHPHASE_NODE "' '" HASHPHASE_BROWSE_REPLAY_SCRIPT "' '" HASHPHASE_CHROMIUM "'";
    for (const std::string& page : pages) {
        command += " '" + page + "'";
    }
    const std::string seen = folder.file("seen.json");
    EXPECT_EQ(std::system((command + " >'" + seen + "'").c_str()), 0) << command;
    return nlohmann::json::parse(std::ifstream(seen), nullptr, false);
}

void expectFrames(const nlohmann::json& seen, const nlohmann::json& found) {
    const nlohmann::json& frames = found["frames"];
    ASSERT_EQ(seen["frames"].size(), frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
        EXPECT_EQ(seen["frames"][i], nlohmann::json({i, frames[i]["exactPairs"],
                                                     frames[i]["missing"], frames[i]["extra"]}));
    }
    EXPECT_EQ(seen["changes"]["lines"], frames[0]["exactPairs"]) << "all pairs are drawn";
}

void expectPictures(const nlohmann::json& seen) {
    const nlohmann::json& changes = seen["changes"];
    EXPECT_GT(changes["colours"], 100) << "an empty picture has few";
    EXPECT_EQ(changes["backByCell"], 0) << "the same picture again, to the last bit";
    for (const char* change : {"byHeight", "byLargerCell", "byPairs", "byLastFrame"}) {
        EXPECT_GT(changes[change], 100) << change;
    }
    EXPECT_NE(seen["inks"][0], seen["inks"][1]) << "on a light and a dark screen";
}

void expectKeys(const nlohmann::json& keys, std::size_t frames) {
    EXPECT_EQ(keys["next"]["frame"], 1);
    EXPECT_EQ(keys["last"]["frame"], frames - 1);
    EXPECT_EQ(keys["home"]["frame"], 0);
    EXPECT_EQ(keys["coloured"]["colouring"], "height");
    EXPECT_GT(keys["changedByTurning"], 100);
    EXPECT_EQ(keys["played"]["frame"], 1);
    EXPECT_EQ(keys["playing"], "false") << "paused by the same key";
}

void expectKeysElsewhere(const nlohmann::json& keys) {
    using nlohmann::json;
    EXPECT_EQ(keys["onTab"], json::parse("[[4, false], [4, false]]")) << "Space is the tab's own";
    EXPECT_EQ(keys["nowhere"], json::parse("[[4, false], [13, false], [13, true], [13, false]]"));
    EXPECT_EQ(keys["typing"], json::parse("[3, false]"));
    EXPECT_EQ(keys["hidden"], json::parse("[3, false]"));
}

void expectLossAndScreens(const nlohmann::json& seen) {
    const nlohmann::json& loss = seen["loss"];
    EXPECT_EQ(loss["during"]["state"], "lost");
    EXPECT_EQ(loss["during"]["playing"], "false");
    EXPECT_EQ(loss["state"], "ready") << "where WebGL2 comes back";
    EXPECT_EQ(loss["changed"], 0) << "the same picture again, to the last bit";
    for (const nlohmann::json& size : seen["screens"]) {
        EXPECT_NEAR(size[0].get<double>(), size[1].get<double>(), 1) << seen["screens"];
    }
}

std::string boxesInARow(int count, float apart) {
    std::ostringstream text;
    for (int i = 0; i < count; ++i) {
        const float low = 0.2F + apart * static_cast<float>(i);
        text << low << " 0.2 0.2 " << low + 0.9F << " 1.1 1.1\n";
    }
    return text.str();
}

/// Writes a page of one frame of these boxes.
std::string pageOfBoxes(const TemporaryFolder& folder, const std::string& name,
                        const std::string& boxes) {
    const std::string page = folder.file(name + ".html");
    comparePage(folder, {"--file", folder.write(name + ".txt", boxes), "--frames", "1"}, page);
    return page;
}

void expectOneFrame(const nlohmann::json& seen) {
    EXPECT_EQ(seen["state"], "ready");
    EXPECT_EQ(seen["faults"].size(), 0U) << seen["faults"];
    EXPECT_EQ(seen["frames"].size(), 1U);
    EXPECT_EQ(seen["played"]["frame"], 0) << "round and round";
}

void expectNeighboursToDiffer(const nlohmann::json& colours, std::size_t bodies) {
    ASSERT_EQ(colours.size(), bodies) << "one a body: " << colours;
    for (std::size_t i = 1; i < bodies; ++i) {
        EXPECT_NE(colours[i], colours[i - 1]) << "cells side by side, number " << i;
    }
}

TEST(ReplayInBrowser, ShowsFramesPairsAndTheFirstWrongOne) {
    if (std::string(HASHPHASE_CHROMIUM).empty() || std::string(HASHPHASE_NODE).empty()) {
        GTEST_SKIP() << "Chromium and Node.js are needed (Debian: chromium, nodejs).";
    }
    const TemporaryFolder folder;
    const std::string page = folder.file("compare.html");
    const nlohmann::json found = comparePage(folder, {"--objects", "1500", "--frames", "14"}, page);
    const nlohmann::json seen =
        browseReplays(folder, {page, pageOfBoxes(folder, "row", boxesInARow(50, 1)),
                               pageOfBoxes(folder, "heap", boxesInARow(550, 0))});
    ASSERT_EQ(seen.size(), 3U);

    const nlohmann::json& with = seen[0]["withWebGL2"];
    EXPECT_EQ(with["state"], "ready");
    EXPECT_EQ(with["faults"].size(), 0U) << with["faults"];
    EXPECT_EQ(with["requests"].size(), 1U) << "of the page alone: " << with["requests"];
    expectFrames(with, found);
    expectPictures(with);
    expectKeys(with["keys"], 14);
    expectKeysElsewhere(with["keysElsewhere"]);
    expectLossAndScreens(with);
    EXPECT_NE(with["cells"]["legend"].get<std::string>().find("which is no broadphase's own size"),
              std::string::npos)
        << "neither of these has cells: " << with["cells"];
    RecordProperty("frames a second", with["framesASecond"].dump());

    const nlohmann::json& wrong = with["wrongPair"];
    const nlohmann::json& objects = found["firstFault"]["objects"];
    EXPECT_EQ(wrong["broadphase"], "forgetful") << "the worst";
    EXPECT_EQ(wrong["frame"], kForgetsFrom);
    EXPECT_EQ(found["firstFault"]["frame"], kForgetsFrom);
    const auto words = wrong["words"].get<std::string>();
    EXPECT_NE(words.find("Objects " + objects[0].dump() + " and " + objects[1].dump() + " overlap"),
              std::string::npos)
        << words;
    EXPECT_EQ(wrong["inPicture"], true);
    for (const nlohmann::json& red : wrong["redAtMarks"]) {
        EXPECT_GT(red, 20) << "pixels in the colour of what is missing";
    }

    const nlohmann::json& without = seen[0]["withoutWebGL2"];
    EXPECT_EQ(without["state"], "without WebGL2");
    EXPECT_EQ(without["canvases"], 0);
    EXPECT_NE(without["words"].get<std::string>().find("this browser has no WebGL2"),
              std::string::npos);
    EXPECT_EQ(without["faults"].size(), 0U) << without["faults"];

    expectOneFrame(seen[1]);
    expectNeighboursToDiffer(seen[1]["colours"], 50);
    expectOneFrame(seen[2]);
    EXPECT_EQ(seen[2]["frames"][0][1], 150'975);
    EXPECT_EQ(seen[2]["lines"], 0) << "more pairs than are listed";
    EXPECT_EQ(seen[2]["counts"].get<std::string>().rfind("150,975 pairs overlap, too many", 0), 0U);
}

}  // namespace
}  // namespace hashphase::demos
