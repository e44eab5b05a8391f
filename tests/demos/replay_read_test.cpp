// SPDX-License-Identifier: Zlib

// Recordings as the scripts of pages read them, by Node.js.

#include <demos/report/base64.hpp>
#include <tests/demos/replay_frames.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <string>

namespace hashphase::demos {
namespace {

class ReplayRead : public testing::Test {
protected:
    // Without it a test ends where it reads.
    static bool isThereNode() { return !std::string(HASHPHASE_NODE).empty(); }
    static constexpr const char* kWithoutNode = "Node.js is needed (Debian: nodejs).";

    /// The output of tests/demos/read_replay.mjs.
    static Json read(const Json& recording) {
        const TemporaryFolder folder;
        const std::string command = "'" HASHPHASE_NODE "' '" HASHPHASE_READ_REPLAY_SCRIPT "' '" +
                                    folder.write("replay.json", recording.dump()) + "' >'" +
                                    folder.file("read.json") + "'";
        EXPECT_EQ(std::system(command.c_str()), 0) << command;
        return Json::parse(std::ifstream(folder.file("read.json")), nullptr, false);
    }

    /// The same of a track, frame by frame.
    static Json read(const ReplayTrack& track) {
        const Json none = Json::array();
        return read(Json{{"frames", track.pairCounts.size()},
                         {"objects", track.isCut.size()},
                         {"low", {0, 0, 0}},
                         {"high", {10, 10, 10}},
                         {"tracks", Json::array({{{"pairsListed", track.pairsListed},
                                                  {"boxStream", base64(track.boxStream)},
                                                  {"pairStream", base64(track.pairStream)}}})},
                         {"broadphases", Json::array({{{"track", 0},
                                                       {"missing", none},
                                                       {"extra", none},
                                                       {"missingListed", none},
                                                       {"extraListed", none},
                                                       {"places", ""}}})}})["frames"];
    }

    static Json placesOf(const std::vector<PairKey>& pairs) {
        Json places = Json::array();
        for (const PairKey pair : pairs) {
            places.push_back(firstOf(pair));
            places.push_back(secondOf(pair));
        }
        return places;
    }
};

TEST_F(ReplayRead, GivesPairsBackAndBoxesToHalfAStep) {
    const auto frames = driftingFrames(150, 12);
    const Json json = recorded(replaySettings(), frames).json();
    const std::string stream = json["tracks"][0]["pairStream"];
    const std::vector<std::size_t> counts = json["tracks"][0]["pairs"];
    EXPECT_LT(stream.size() * 3 / 4, std::accumulate(counts.begin(), counts.end(), std::size_t{0}))
        << "less than a byte for a pair in a frame";
    if (!isThereNode()) {
        GTEST_SKIP() << kWithoutNode;
    }
    const Json seen = read(json);
    ASSERT_EQ(seen["frames"].size(), frames.size());
    EXPECT_GT(seen["every"], 1) << "not all frames were kept";
    for (std::size_t frame = 0; frame < frames.size(); ++frame) {
        const FrameBoxes& boxes = frames[frame];
        const std::vector<PairKey> pairs = overlappingPairs(boxes);
        EXPECT_EQ(seen["frames"][frame]["pairs"], placesOf(pairs)) << frame;
        std::vector<int> overlapCounts(boxes.size());
        for (const PairKey pair : pairs) {
            ++overlapCounts[firstOf(pair)];
            ++overlapCounts[secondOf(pair)];
        }
        const auto numbers = seen["frames"][frame]["numbers"].get<std::vector<double>>();
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const double low = json["low"][axis];
                const double step = (json["high"][axis].get<double>() - low) / 65535;
                const auto k = static_cast<int>(axis);
                EXPECT_NEAR(numbers[7 * i + axis] * step + low, boxes[i].center()[k], step * 0.501);
                EXPECT_NEAR(numbers[7 * i + 3 + axis] * step, boxes[i].sizes()[k], step * 0.501);
            }
            EXPECT_EQ(numbers[7 * i + 6], overlapCounts[i]);
        }
    }
}

TEST_F(ReplayRead, GivesTheHeightsOfTheGroundBack) {
    if (!isThereNode()) {
        GTEST_SKIP() << kWithoutNode;
    }
    ReplaySettings settings = replaySettings();
    settings.bounds = kTenMetres;
    settings.ground = heightOfSlope;
    const Json seen = read(recorded(settings, driftingFrames(50, 1)).json());
    EXPECT_EQ(seen["steps"], sampleGround(heightOfSlope, kTenMetres).heights);
}

TEST_F(ReplayRead, TakesForWorstWhatMissesMostOfThoseWithARecordedWrongPair) {
    if (!isThereNode()) {
        GTEST_SKIP() << kWithoutNode;
    }
    const FrameBoxes boxes = driftingFrames(200, 1).front();
    const std::vector<PairKey> exact = overlappingPairs(boxes);
    ASSERT_GT(exact.size(), 3U);
    const auto worstOf = [&](const std::vector<std::array<std::size_t, 2>>& missingAndExtra) {
        ReplaySettings settings = replaySettings();
        settings.broadphases.resize(missingAndExtra.size());
        ReplayRecording recording(settings);
        for (std::size_t i = 0; i < missingAndExtra.size(); ++i) {
            const auto [missing, extra] = missingAndExtra[i];
            recording.add(
                i, {boxes, exact, std::span(exact).first(missing), std::span(exact).first(extra)});
        }
        recording.finishFrame();
        return recording.json();
    };
    EXPECT_EQ(read(worstOf({{0, 0}, {1, 0}, {0, 3}}))["worst"], 1) << "most missing ones";
    EXPECT_EQ(read(worstOf({{1, 1}, {1, 3}, {1, 2}}))["worst"], 1) << "most extra ones of equals";
    EXPECT_EQ(read(worstOf({{0, 0}, {0, 0}}))["worst"], 0) << "none is wrong";
    Json json = worstOf({{0, 1}, {2, 0}});
    json["broadphases"][1]["first"] = nullptr;
    EXPECT_EQ(read(json)["worst"], 0) << "the others are not recorded";
}

TEST_F(ReplayRead, HasAFewBytesOfAFrameInWhichNothingMoves) {
    const FrameBoxes boxes = driftingFrames(1'000, 1).front();
    ReplayTrack track(kTenMetres, firstNumbers(1'000), 0);
    track.add(boxes, {}, {});
    const std::size_t first = track.boxStream.size();
    track.add(boxes, {}, {});
    EXPECT_EQ(track.boxStream.size(), first + 3) << "0, and 999 in two groups of seven bits";
    ReplayTrack shorter = track;
    shorter.removeLast();
    EXPECT_EQ(shorter.boxStream.size(), first);
    if (!isThereNode()) {
        GTEST_SKIP() << kWithoutNode;
    }
    const Json seen = read(track);
    EXPECT_EQ(seen[0]["numbers"].size(), 7'000U);
    EXPECT_EQ(seen[1]["numbers"], seen[0]["numbers"]);
}

TEST_F(ReplayRead, CutsOffWhatIsHugeOrHasNoNumbers) {
    const float most = std::numeric_limits<float>::max();
    const Vector3<float> one = Vector3<float>::Ones();
    const FrameBoxes boxes{{one, 2 * one},
                           {-kEndless * one, kEndless * one},
                           {-most * one, most * one},
                           {Vector3<float>(kNan, 1, 1), 2 * one},
                           {Vector3<float>(1e30F, 0, 0), Vector3<float>(1e30F, 1, 1)}};
    ReplayTrack track(kTenMetres, firstNumbers(boxes.size()), 0);
    track.add(boxes, {}, {});
    EXPECT_EQ(track.isCut, (std::vector<std::uint8_t>{0, 1, 1, 1, 1}));
    if (!isThereNode()) {
        GTEST_SKIP() << kWithoutNode;
    }
    EXPECT_EQ(read(track)[0]["numbers"],
              Json({9830,  9830,  9830,  6554,  6554,  6554,  0,    // inside
                    32768, 32768, 32768, 65535, 65535, 65535, 0,    // everywhere
                    32768, 32768, 32768, 65535, 65535, 65535, 0,    //
                    0,     0,     0,     0,     0,     0,     0,    // no size
                    65535, 3277,  3277,  0,     6554,  6554,  0}))  // at the world's end
        << "of each its centre, its edges, and its overlaps";
}

TEST_F(ReplayRead, HasNoPairsWhereThereAreTooManyToBeListed) {
    const std::vector<PairKey> few{pairKey(0, 1), pairKey(0, 100'000)};
    const std::vector<PairKey> many{pairKey(0, 1), pairKey(1, 2), pairKey(1, 3)};
    ReplayTrack track(kTenMetres, {}, 2);
    std::size_t bytes = 0;
    for (const auto& frame : {few, many, few, {pairKey(5, 9)}}) {
        bytes = track.pairStream.size();
        track.add({}, {}, frame);
    }
    EXPECT_EQ(track.pairCounts, (std::vector<std::size_t>{2, 3, 2, 1}));
    EXPECT_EQ(track.pairsListed, (std::vector<std::size_t>{2, 0, 2, 1}));
    EXPECT_GT(track.pairStream.size(), bytes);
    track.removeLast();
    EXPECT_EQ(track.pairStream.size(), bytes);
    if (!isThereNode()) {
        GTEST_SKIP() << kWithoutNode;
    }
    const Json seen = read(track);
    ASSERT_EQ(seen.size(), 3U);
    EXPECT_EQ(seen[0]["pairs"], placesOf(few));
    EXPECT_EQ(seen[1]["pairs"], Json::array());
    EXPECT_EQ(seen[2]["pairs"], placesOf(few));
}

}  // namespace
}  // namespace hashphase::demos
