// SPDX-License-Identifier: Zlib
#include <demos/compare/reference_pairs.hpp>
#include <demos/compare/report.hpp>
#include <demos/compare/verifier.hpp>
#include <demos/report/json_values.hpp>
#include <demos/report/statistics.hpp>
#include <demos/scenes/random.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace hashphase::demos {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

Aabb<float> cube(float x, float y, float z, float edge) {
    return {Vector3<float>(x, y, z), Vector3<float>(x + edge, y + edge, z + edge)};
}

std::vector<PairKey> exactPairs(ReferenceMethod method, const std::vector<Aabb<float>>& boxes,
                                const std::vector<CollisionFilter>& filters = {}) {
    std::vector<PairKey> pairs{pairKey(7, 8)};  // must be replaced
    findExactPairs(method, boxes, filters, pairs);
    return pairs;
}

class ReferencePairs : public testing::TestWithParam<ReferenceMethod> {};

TEST_P(ReferencePairs, CountTouchingBoxesAndNotThoseAHairApart) {
    const float above = std::nextafter(1.0F, 2.0F);
    EXPECT_EQ(exactPairs(GetParam(), {cube(0, 0, 0, 1), cube(1, 1, 1, 1)}),
              std::vector<PairKey>{pairKey(0, 1)});
    for (int axis = 0; axis < 3; ++axis) {
        Aabb<float> apart = cube(0, 0, 0, 1);
        apart.translate(above * Vector3<float>::Unit(axis));
        EXPECT_TRUE(exactPairs(GetParam(), {cube(0, 0, 0, 1), apart}).empty()) << axis;
    }
}

TEST_P(ReferencePairs, LeaveOutNanAndAcceptInfinity) {
    const Aabb<float> all{Vector3<float>::Constant(-kInfinity),
                          Vector3<float>::Constant(kInfinity)};
    Aabb<float> nan = all;
    nan.max().y() = std::nanf("");
    EXPECT_EQ(exactPairs(GetParam(), {nan, cube(5, 5, 5, 1), all, nan}),
              std::vector<PairKey>{pairKey(1, 2)});
}

TEST_P(ReferencePairs, TakeInvertedBoxesAtTheirWord) {
    // min 2 and max 1: overlaps what reaches from at most 1 to at least 2, on every axis.
    const Aabb<float> inverted{Vector3<float>::Constant(2), Vector3<float>::Constant(1)};
    EXPECT_EQ(exactPairs(GetParam(), {inverted, cube(0, 0, 0, 3), cube(1.2F, 0, 0, 3)}),
              (std::vector<PairKey>{pairKey(0, 1), pairKey(1, 2)}));
}

TEST_P(ReferencePairs, RespectTheFilters) {
    const std::vector<Aabb<float>> boxes(3, cube(0, 0, 0, 1));
    const std::vector<CollisionFilter> filters{kStaticFilter, {}, kStaticFilter};
    EXPECT_EQ(exactPairs(GetParam(), boxes, filters),
              (std::vector<PairKey>{pairKey(0, 1), pairKey(1, 2)}));
}

INSTANTIATE_TEST_SUITE_P(Methods, ReferencePairs,
                         testing::Values(ReferenceMethod::kSweep, ReferenceMethod::kBrute));

TEST(ReferenceMethods, FindTheSamePairs) {
    Random random(20);
    for (int round = 0; round < 50; ++round) {
        std::vector<Aabb<float>> boxes;
        for (int i = 0; i < 120; ++i) {
            // Coarse coordinates make many exact ties.
            boxes.push_back(cube(std::floor(random.between(0, 12)),
                                 std::floor(random.between(0, round % 2 == 0 ? 2.0F : 12.0F)),
                                 std::floor(random.between(0, 12)),
                                 std::floor(random.between(-1, 4))));
        }
        EXPECT_EQ(exactPairs(ReferenceMethod::kSweep, boxes),
                  exactPairs(ReferenceMethod::kBrute, boxes));
    }
}

TEST(Verifier, TellsMissingAndExtraPairs) {
    Verifier verifier;
    const PairVerdict& verdict =
        verifier.judge(std::vector{pairKey(0, 1), pairKey(2, 3), pairKey(2, 9)},
                       std::vector{pairKey(0, 1), pairKey(0, 4), pairKey(2, 3), pairKey(5, 6)});
    EXPECT_EQ(verdict.missing, (std::vector{pairKey(0, 4), pairKey(5, 6)}));
    EXPECT_EQ(verdict.extra, std::vector{pairKey(2, 9)});
    EXPECT_EQ(verdict.stale, 0U);
}

TEST(Verifier, CallsAPairReportedTwiceExtra) {
    Verifier verifier;
    const PairVerdict& verdict =
        verifier.judge(std::vector{pairKey(0, 1), pairKey(0, 1)}, std::vector{pairKey(0, 1)});
    EXPECT_TRUE(verdict.missing.empty());
    EXPECT_EQ(verdict.extra.size(), 1U);
}

TEST(Verifier, CallsAnExtraPairStaleWhileItIsReportedSinceItOverlapped) {
    const std::vector pair{pairKey(0, 1)};
    const std::vector<PairKey> none;
    Verifier verifier;
    EXPECT_EQ(verifier.judge(pair, none).stale, 0U) << "it has not overlapped yet";
    EXPECT_EQ(verifier.judge(pair, pair).stale, 0U) << "it overlaps";
    EXPECT_EQ(verifier.judge(pair, none).stale, 1U);
    EXPECT_EQ(verifier.judge(pair, none).stale, 1U) << "and stays stale";
    EXPECT_EQ(verifier.judge(none, none).stale, 0U);
    EXPECT_EQ(verifier.judge(pair, none).stale, 0U) << "reported anew, it is merely extra";
}

TEST(Statistics, PercentilesInterpolateBetweenNeighbours) {
    EXPECT_DOUBLE_EQ(percentile({10, 20, 30, 40}, 0.5), 25);
    EXPECT_DOUBLE_EQ(percentile({10, 20, 30, 40}, 0.05), 11.5);
    EXPECT_DOUBLE_EQ(percentile({1, 2, 3}, 0), 1);
    EXPECT_DOUBLE_EQ(percentile({1, 2, 3}, 1), 3);
    EXPECT_DOUBLE_EQ(percentile({7}, 0.95), 7) << "of a single value that value";
}

TEST(CompareFindings, LeaveOutWarmUpFramesFromTimesButNotFromCounts) {
    Measurements measured;
    for (int frame = 0; frame < 3; ++frame) {
        measured.add("frames", {{"name", "dbvt"},
                                {"frame", frame},
                                {"measured", frame > 0},
                                {"pairs", 7},
                                {"exact_pairs", 2},
                                {"missing", 0},
                                {"extra", frame == 0 ? 5 : 1},
                                {"stale", 0},
                                {"set_aabb_ms", frame == 0 ? 100 : 2},
                                {"calculate_ms", 1},
                                {"step_ms", Datum()}});
    }
    measured.add("broadphases", {{"name", "dbvt"},
                                 {"title", "btDbvtBroadphase"},
                                 {"ours", false},
                                 {"fill_ms", 4},
                                 {"left_out_after", Datum()},
                                 {"remove_ms", Datum()},
                                 {"memory", Datum()}});
    measured.add("run", {{"scene", "s"},
                         {"description", "a scene"},
                         {"noun", "boxes"},
                         {"from_file", false},
                         {"objects", 9},
                         {"frames_asked", 3},
                         {"warm_up", 1},
                         {"frames_done", 3},
                         {"removed", 0},
                         {"seed", 1},
                         {"reference", "sweep"},
                         {"time_limit", Datum()},
                         {"interrupted", false},
                         {"stopped", Datum()}});
    const Findings findings = compareFindings(measured);
    const Json result = rowsJson(findings.rows.at("broadphases")).front();
    EXPECT_EQ(result["bothMs"]["p95"], 3);
    EXPECT_TRUE(result["stepMs"].is_null());
    EXPECT_EQ(result["extra"]["total"], 7);
    EXPECT_EQ(result["extra"]["mostInAFrame"], 5);
    EXPECT_EQ(findings.holds, std::nullopt) << "none of ours took part";
}

}  // namespace
}  // namespace hashphase::demos
