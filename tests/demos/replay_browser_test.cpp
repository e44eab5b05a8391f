// SPDX-License-Identifier: Zlib
#include <demos/compare/compare_command.hpp>
#include <tests/demos/typed.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cstdlib>
#include <sstream>
#include <utility>

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

std::array<BroadphaseKind, 2> kindsToReplay() {
    const auto make = [](const BroadphaseNeeds& needs) -> std::unique_ptr<btBroadphaseInterface> {
        return std::make_unique<btSimpleBroadphase>(static_cast<int>(needs.objects) + 1);
    };
    const auto makeForgetful =
        [](const BroadphaseNeeds& needs) -> std::unique_ptr<btBroadphaseInterface> {
        return std::make_unique<Forgets>(static_cast<int>(needs.objects) + 1);
    };
    return {BroadphaseKind{"forgetful", "a wrong one", "for tests", false, 1'000'000, true,
                           makeForgetful},
            BroadphaseKind{"hash", "a right one", "for tests", true, 1'000'000, true, make}};
}

/// Writes the page of a comparison, and returns what it found of "forgetful" itself.
nlohmann::json comparePage(const TemporaryFolder& folder, const std::string& name,
                           std::vector<std::string> arguments) {
    const auto kinds = kindsToReplay();
    const std::string json = folder.file("comparison.json");
    arguments.insert(arguments.end(), {"--html", folder.file(name), "--json", json});
    const Typed ran = typed(compareCommand(kinds), arguments);
    EXPECT_EQ(ran.exitCode, kExitOk) << ran.err;
    return nlohmann::json::parse(std::ifstream(json))["broadphases"][0];
}

std::string boxesInARow(int count, float apart) {
    std::ostringstream text;
    for (int i = 0; i < count; ++i) {
        const float low = 0.2F + apart * static_cast<float>(i);
        text << low << " 0.2 0.2 " << low + 0.9F << " 1.1 1.1\n";
    }
    return text.str();
}

TEST(ReplayInBrowser, ShowsFramesPairsAndTheFirstWrongOne) {
    if (std::string(HASHPHASE_CHROMIUM).empty() || std::string(HASHPHASE_NODE).empty()) {
        GTEST_SKIP() << "Chromium and Node.js are needed (Debian: chromium, nodejs).";
    }
    const TemporaryFolder folder;
    const nlohmann::json found =
        comparePage(folder, "compare.html", {"--objects", "1500", "--frames", "14"});
    EXPECT_EQ(found["firstFault"]["frame"], 5);
    for (const auto& [name, boxes] :
         {std::pair{"row", boxesInARow(50, 1)}, std::pair{"heap", boxesInARow(550, 0)}}) {
        comparePage(folder, std::string(name) + ".html",
                    {"--file", folder.write("boxes.txt", boxes), "--frames", "1"});
    }
    comparePage(folder, "wrong.html",
                {"--objects", "1500", "--frames", "8", "--broadphases", "forgetful"});
    std::string command = "'" HASHPHASE_NODE "' '" HASHPHASE_BROWSE_REPLAY_SCRIPT
                          "' '" HASHPHASE_CHROMIUM "' '" +
                          folder.write("found.json", found.dump()) + "'";
    for (const char* page : {"compare", "row", "heap", "wrong"}) {
        command += " '" + folder.file(page) + ".html'";
    }
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
}

}  // namespace
}  // namespace hashphase::demos
