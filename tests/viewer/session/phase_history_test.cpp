// SPDX-License-Identifier: Zlib

#include <demos/viewer/session/session.hpp>
#include <demos/viewer/stage/phases.hpp>
#include <tests/viewer/session/stages.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <random>
#include <vector>

namespace hashphase::demos {
namespace {

void addFrame(PhaseHistory& history, double milliseconds) {
    history.add(std::vector<PhaseTime>{{"stand", milliseconds}});
}

PhaseHistory historyOf(std::initializer_list<double> frames) {
    PhaseHistory history;
    for (const double frame : frames) {
        addFrame(history, frame);
    }
    return history;
}

// The smallest of the sample that so large a share of it does not exceed, counted one by one.
double bruteForceQuantile(const std::vector<double>& sample, double share) {
    double best = *std::max_element(sample.begin(), sample.end());
    for (const double candidate : sample) {
        const auto notAbove = std::count_if(sample.begin(), sample.end(),
                                            [&](double other) { return other <= candidate; });
        if (static_cast<double>(notAbove) >= share * static_cast<double>(sample.size())) {
            best = std::min(best, candidate);
        }
    }
    return best;
}

TEST(PhaseHistory, KnowsTheMedianTheSlowestTwentiethAndTheWorstFrame) {
    std::mt19937 random(5);
    std::uniform_int_distribution<int> milliseconds(1, 999);
    for (const std::size_t frames : {2U, 3U, 5U, 20U, 21U, 100U, 240U, 241U, 1000U}) {
        PhaseHistory history;
        std::vector<double> all;
        for (std::size_t frame = 0; frame < frames; ++frame) {
            all.push_back(milliseconds(random));
            addFrame(history, all.back());
        }
        const std::size_t told = std::min(frames - 1, PhaseHistory::kFrames);
        const std::vector<double> last(all.end() - static_cast<std::ptrdiff_t>(told), all.end());
        ASSERT_EQ(history.rows().size(), 1U);
        EXPECT_EQ(history.toldCount(), told) << frames;
        EXPECT_EQ(history.median(history.rows()[0]), bruteForceQuantile(last, 0.5)) << frames;
        EXPECT_EQ(history.p95(history.rows()[0]), bruteForceQuantile(last, 0.95)) << frames;
        EXPECT_EQ(history.worst(history.rows()[0]), *std::ranges::max_element(last)) << frames;
    }
}

TEST(PhaseHistory, LeavesOutTheFirstFrameUnlessThereIsNoOther) {
    EXPECT_EQ(historyOf({}).medianTotal(), 0);
    EXPECT_EQ(historyOf({}).p95Total(), 0);
    EXPECT_EQ(historyOf({}).worstTotal(), 0);
    EXPECT_EQ(historyOf({19}).medianTotal(), 19);
    EXPECT_EQ(historyOf({19}).p95Total(), 19);
    EXPECT_EQ(historyOf({19}).worstTotal(), 19);
    EXPECT_EQ(historyOf({19, 8}).medianTotal(), 8);
    EXPECT_EQ(historyOf({19, 8}).p95Total(), 8);
    EXPECT_EQ(historyOf({19, 8, 9, 7}).medianTotal(), 8);
    EXPECT_EQ(historyOf({19, 8, 9, 7}).p95Total(), 9);
    EXPECT_EQ(historyOf({19, 8, 9, 7}).worstTotal(), 9);
}

TEST(PhaseHistory, AddsUpThePhasesOfEachFrame) {
    PhaseHistory history;
    for (int frame = 0; frame < 1000; ++frame) {
        const double spike = frame % 100 == 0 ? 70 : frame % 10 == 0 ? 9 : 1;
        history.add(std::vector<PhaseTime>{{"even", 2}, {"spiky", spike}});
    }
    ASSERT_EQ(history.rows().size(), 2U);
    EXPECT_EQ(history.frameCount(), PhaseHistory::kFrames);
    EXPECT_EQ(history.median(history.rows()[1]), 1);
    EXPECT_EQ(history.p95(history.rows()[1]), 9);
    EXPECT_EQ(history.medianTotal(), 3);
    EXPECT_EQ(history.p95Total(), 11);
    EXPECT_EQ(history.worst(history.rows()[1]), 70);
    EXPECT_EQ(history.worstTotal(), 72);
}

TEST(PhaseHistory, ForgetsPhasesThatAreNoMore) {
    PhaseHistory history;
    history.add(std::vector<PhaseTime>{{"stand", 2}, {"once", 1}});
    for (std::size_t frame = 1; frame < PhaseHistory::kFrames; ++frame) {
        addFrame(history, 2);
    }
    EXPECT_EQ(history.rows().size(), 2U);
    addFrame(history, 2);
    EXPECT_EQ(history.rows().size(), 1U);
    EXPECT_EQ(history.medianTotal(), 2);
}

TEST(PhaseLines, HaveTheTimesOfBothHistoriesByPhase) {
    PhaseHistory now;
    PhaseHistory former;
    for (int frame = 0; frame < 5; ++frame) {
        now.add(std::vector<PhaseTime>{{"pair", 1}, {"culling", 2}});
        former.add(std::vector<PhaseTime>{{"culling", 3}, {"set boxes", 4}});
    }
    const std::vector<PhaseLine> alone = phaseLines(now, nullptr);
    ASSERT_EQ(alone.size(), 3U);
    EXPECT_EQ(alone[1].name, "culling");
    EXPECT_EQ(alone[1].median, 2);
    EXPECT_EQ(alone[1].before, std::nullopt);
    EXPECT_EQ(alone[2].name, "total");
    EXPECT_EQ(alone[2].worst, 3);
    const std::vector<PhaseLine> both = phaseLines(now, &former);
    ASSERT_EQ(both.size(), 4U);
    EXPECT_EQ(both[0].before, std::nullopt) << "no phase of the former history";
    EXPECT_EQ(both[1].before, 3);
    EXPECT_EQ(both[2].name, "set boxes");
    EXPECT_EQ(both[2].median, std::nullopt) << "no phase of the present history";
    EXPECT_EQ(both[2].before, 4);
    EXPECT_EQ(both[3].median, 3);
    EXPECT_EQ(both[3].before, 7);
    EXPECT_EQ(phaseLines({}, &former).back().median, std::nullopt) << "no frame has come";
}

TEST(PhaseHistory, BeginsAgainWithAnotherBroadphaseAndTheFormerOneIsKept) {
    Session session({.name = "wander", .file = {}, .objects = 200, .seed = 1});
    step(session, 4);
    session.run("broadphase hash");
    EXPECT_EQ(session.history.frameCount(), 4U) << "is no swap";
    EXPECT_THROW(static_cast<void>(session.reading("millisecondsBefore")), InputError);
    const double median = session.history.medianTotal();
    session.run("broadphase dbvt");
    EXPECT_EQ(session.history.frameCount(), 0U);
    session.run("broadphase simple");
    ASSERT_TRUE(session.former);
    EXPECT_EQ(session.former->broadphase, "hash") << "no frame was simulated with dbvt";
    EXPECT_EQ(session.reading("millisecondsBefore"), median);
    step(session, 3);
    EXPECT_EQ(session.history.frameCount(), 3U);
    EXPECT_EQ(session.reading("millisecondsBefore"), median);
    session.run("broadphase hash");
    EXPECT_EQ(session.former->broadphase, "simple");
    session.run("restart");
    EXPECT_FALSE(session.former);
}

TEST(PhaseHistory, IsWhatASessionReads) {
    Session session({.name = "wander", .file = {}, .objects = 200, .seed = 1});
    step(session, 4);
    EXPECT_EQ(session.reading("milliseconds"), session.history.medianTotal());
    EXPECT_EQ(session.reading("p95"), session.history.p95Total());
    EXPECT_EQ(session.reading("worst"), session.history.worstTotal());
    EXPECT_GE(session.reading("p95"), session.reading("milliseconds"));
    EXPECT_GE(session.reading("worst"), session.reading("p95"));
}

}  // namespace
}  // namespace hashphase::demos
