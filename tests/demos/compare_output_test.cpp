// SPDX-License-Identifier: Zlib

// What `hashphase compare` prints, how much it runs, and what is left of it when it is interrupted.

#include <demos/compare/compare_command.hpp>
#include <demos/scenes/file_bytes.hpp>
#include <tests/demos/interruptible.hpp>
#include <tests/demos/typed.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace hashphase::demos {
namespace {

/// Bullet's brute force, during whose fourth frame somebody presses Ctrl-C.
class Interrupted4 : public btSimpleBroadphase {
public:
    using btSimpleBroadphase::btSimpleBroadphase;

    void calculateOverlappingPairs(btDispatcher* dispatcher) override {
        btSimpleBroadphase::calculateOverlappingPairs(dispatcher);
        if (++frame_ == 4) {
            std::raise(SIGINT);
        }
    }

private:
    int frame_ = 0;
};

const std::array kInterrupted{
    BroadphaseKind{"simple", "one for tests", "for tests", true, 1'000'000, true,
                   [](const BroadphaseNeeds& needs) -> std::unique_ptr<btBroadphaseInterface> {
                       return std::make_unique<Interrupted4>(static_cast<int>(needs.objects) + 1);
                   }}};

Typed compared(std::vector<std::string> arguments,
               std::span<const BroadphaseKind> kinds = broadphaseKinds()) {
    return typed(compareCommand(kinds), std::move(arguments));
}

std::size_t longestLine(const std::string& text) {
    std::size_t longest = 0;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        longest = std::max(longest, line.size());
    }
    return longest;
}

/// All but the verdict, which is whole.
std::string withoutLastLine(const std::string& text) {
    return text.substr(0, text.rfind('\n', text.size() - 2));
}

TEST(CompareTable, HasTheColumnsThatDecideAndAllOnRequest) {
    const std::vector<std::string> few{"--objects", "2000", "--frames", "6"};
    const Typed brief = compared(few);
    EXPECT_TRUE(holds(brief.out, "\nbroadphase     ms a frame"));
    EXPECT_LE(longestLine(withoutLastLine(brief.out)), 100U) << brief.out;
    for (const char* column : {"setAabb for all", "stale", "memory", "fill"}) {
        EXPECT_FALSE(holds(brief.out, column));
    }
    std::vector<std::string> all = few;
    all.emplace_back("--verbose");
    const Typed verbose = compared(all);
    for (const char* column : {"setAabb for all", "stale", "memory", "fill", "remove"}) {
        EXPECT_TRUE(holds(verbose.out, column));
    }
}

TEST(CompareTable, HasTheWholeStepOfAWorldAndItsPartsOnRequest) {
    const std::vector<std::string> few{"--scene", "stack", "--objects", "20", "--frames", "8"};
    const Typed brief = compared(few);
    EXPECT_TRUE(holds(brief.out, "  whole step  "));
    EXPECT_TRUE(holds(brief.out, "left to gain"));
    EXPECT_FALSE(holds(brief.out, "part of a step"));
    EXPECT_LE(longestLine(withoutLastLine(brief.out)), 100U) << brief.out;
    std::vector<std::string> all = few;
    all.emplace_back("--verbose");
    EXPECT_TRUE(holds(compared(all).out, "part of a step"));
}

TEST(CompareTable, ShowsExtraPairsByTheirShareInTheVerdictToo) {
    const TemporaryFolder folder;
    const std::string path = folder.file("r.json");
    const Typed outcome = compared({"--scene", "uniform", "--objects", "1000", "--frames", "30",
                                    "--broadphases", "hash,dbvt", "--json", path});
    const auto report = nlohmann::json::parse(std::ifstream(path));
    const int extra = report["broadphases"][1]["extra"]["total"];
    double exact = 0;
    for (const auto& frame : report["broadphases"][1]["frames"]) {
        exact += frame["exactPairs"].get<double>();
    }
    const double share = 100 * extra / exact;
    std::ostringstream text;
    text.precision(share < 10 ? 1 : 0);
    text << std::fixed << " (" << share << " % of the true pairs)";
    const std::size_t verdict = outcome.out.rfind('\n', outcome.out.size() - 2);
    EXPECT_TRUE(holds(outcome.out.substr(0, verdict), text.str() + "\n")) << "in the table";
    EXPECT_TRUE(holds(outcome.out.substr(verdict), "; btDbvtBroadphase lists extra pairs: "));
    EXPECT_TRUE(holds(outcome.out.substr(verdict), text.str() + "; pair sets exact in"));
}

TEST(CompareQuick, RunsFewerObjectsAndFramesUnlessTheyAreGiven) {
    EXPECT_TRUE(holds(compared({"--quick", "--broadphases", "hash", "--frames", "2"}).out,
                      "\n10,000 spheres, 2 frames"));
    EXPECT_TRUE(holds(compared({"--quick", "--broadphases", "hash", "--objects", "50"}).out,
                      "\n50 spheres, 60 frames"));
    EXPECT_TRUE(holds(
        compared({"--quick", "--scene", "stack", "--broadphases", "hash", "--frames", "2"}).out,
        " bodies, 2 frames"));
}

TEST(CompareInterruption, ReportsWhatWasMeasuredUntilThen) {
    const TemporaryFolder folder;
    const std::string json = folder.write("r.json", "old");
    const std::string html = folder.write("r.html", "old");
    const Typed ended = compared({"--objects", "50", "--frames", "60", "--json", json, "--html",
                                  html, "--csv", folder.file("r.csv")},
                                 kInterrupted);
    EXPECT_EQ(ended.exitCode, 130);
    EXPECT_TRUE(holds(ended.out, "\nThe run was interrupted after 4 of 60 frames.\n"));
    EXPECT_TRUE(holds(ended.out, "\nsimple "));
    EXPECT_TRUE(holds(ended.out, "\n50 spheres, 4 frames; pair sets exact in every frame: yes\n"));
    const auto report = nlohmann::json::parse(std::ifstream(json));
    EXPECT_EQ(report["verdict"]["interrupted"], true);
    EXPECT_EQ(report["verdict"]["timeLimitHit"], false);
    EXPECT_EQ(report["verdict"]["framesDone"], 4);
    EXPECT_TRUE(holds(readFile(html), "The run was interrupted after 4 of 60 frames."));
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
        EXPECT_NE(entry.path().extension(), ".partial");
    }
}

}  // namespace
}  // namespace hashphase::demos
