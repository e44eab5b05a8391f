// SPDX-License-Identifier: Zlib
//
// The page of a comparison.

#include <demos/compare/compare_command.hpp>
#include <demos/compare/trial.hpp>
#include <demos/scenes/file_bytes.hpp>
#include <tests/demos/spoiled_broadphase.hpp>
#include <tests/demos/typed.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <fstream>

namespace hashphase::demos {
namespace {

Typed runForPage(std::vector<std::string> arguments,
                 std::span<const BroadphaseKind> kinds = broadphaseKinds()) {
    return typed(compareCommand(kinds), std::move(arguments));
}

TEST(ComparePage, BeginsWithTheVerdict) {
    const TemporaryFolder folder;
    const std::string path = folder.file("r.html");
    const Typed outcome = runForPage({"--objects", "50", "--frames", "8", "--html", path});
    ASSERT_EQ(outcome.exitCode, kExitOk) << outcome.err;
    const std::string html = readFile(path);
    const std::size_t verdict = html.find("pair sets exact in every frame: yes.</p>");
    EXPECT_LT(verdict, html.find("Are the pairs right?</h2>"));
    EXPECT_NE(html.find(">holds</span><span>&#39;hash&#39; lists exactly the pairs"),
              std::string::npos);
    EXPECT_TRUE(holds(html, "id=\"compare-times\""));
    EXPECT_TRUE(holds(html, "id=\"compare-trace\""));
    EXPECT_FALSE(holds(html, "whole step")) << "boxes have no simulation";
}

TEST(ComparePage, HasNoChartsWhereNothingWasTimed) {
    const TemporaryFolder folder;
    const std::string path = folder.file("r.html");
    runForPage(
        {"--objects", "2000", "--time-limit", "0.000001", "--broadphases", "hash", "--html", path});
    const std::string page = readFile(path);
    EXPECT_FALSE(holds(page, "id=\"compare-times\""));
    EXPECT_TRUE(holds(page, "The time limit of 1e-06 s was reached after 0 of 120 frames."));
    EXPECT_FALSE(holds(page, "class=\"verdict bad\"")) << "nothing was wrong";
    EXPECT_FALSE(holds(page, "class=\"verdict\"")) << "nor was it checked";
}

TEST(ComparePage, DrawsManyFramesTogether) {
    const TemporaryFolder folder;
    const std::string path = folder.file("r.html");
    runForPage({"--objects", "3", "--frames", "2511", "--broadphases", "hash,dbvt", "--html", path,
                "--replay-frames", "0", "--csv", folder.file("r.csv")});
    const std::string html = readFile(path);
    const std::size_t trace = html.find("id=\"compare-trace\"");
    ASSERT_NE(trace, std::string::npos);
    EXPECT_NE(html.find("median of 3 frames, the range is from their minimum", trace),
              std::string::npos);
    std::size_t rows = 0;
    const std::size_t end = html.find("</figure>", trace);
    for (std::size_t at = trace; (at = html.find("<tr>", at + 1)) < end;) {
        ++rows;
    }
    EXPECT_EQ(rows, 1 + 2 * 834U) << "2,501 frames were timed";
    const std::string text = readFile(folder.file("r.csv"));
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 2 * 2511) << "all of them";
}

/// Lists all pairs of three boxes, of which the first two overlap.
class ListsAll : public SpoiledBroadphase {
    using SpoiledBroadphase::SpoiledBroadphase;
    void spoil(btDispatcher* /*dispatcher*/) override {
        for (const std::size_t other : {0, 1}) {
            getOverlappingPairCache()->addOverlappingPair(proxies_[other], proxies_[2]);
        }
    }
};

TEST(ComparePage, TellsTheWorstFrameAndTheShareOfExtraPairs) {
    const TemporaryFolder folder;
    const std::string json = folder.file("r.json");
    const std::string path = folder.file("r.html");
    const std::array kinds{
        BroadphaseKind{"all", "one for tests", "for tests", false, 1'000'000, true,
                       [](const BroadphaseNeeds& needs) -> std::unique_ptr<btBroadphaseInterface> {
                           return std::make_unique<ListsAll>(static_cast<int>(needs.objects) + 1);
                       }}};
    const std::string boxes =
        folder.write("b.txt", "0 0 0 1 1 1\n0 0 0 1 1 1.1\n50 50 50 51 51 51\n");
    runForPage({"--file", boxes, "--frames", "6", "--html", path, "--json", json}, kinds);
    const auto report = nlohmann::json::parse(std::ifstream(json));
    const nlohmann::json& both = report["broadphases"][0]["bothMs"];
    EXPECT_GE(both["worst"], both["p95"]);
    const std::string html = readFile(path);
    EXPECT_TRUE(
        holds(html,
              "both, 95th percentile [ms]</th><th scope=\"col\" class=\"number\">both, worst frame "
              "[ms]</th>"));
    EXPECT_TRUE(holds(html, "extra pairs [% of the true pairs]</th>"));
    EXPECT_TRUE(holds(html, "<td class=\"number\">6</td><td class=\"number\">100</td>"))
        << "6 extra, of 6 true pairs";
}

}  // namespace
}  // namespace hashphase::demos
