// SPDX-License-Identifier: Zlib
//
// When pairs are compared with the exact ones, and when nobody can say.

#include <demos/viewer/session/session.hpp>
#include <tests/viewer/session/steps.hpp>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace hashphase::demos {
namespace {

Session checkedSession() {
    Session session({.name = "wander", .file = {}, .objects = 3000, .seed = 1}, 800, 600);
    session.run("check on");
    step(session, 10);
    return session;
}

TEST(Check, SaysNothingBetweenAChangeAndTheNextFrame) {
    Session session = checkedSession();
    for (const char* change : {"cell 4", "broadphase dbvt", "cell 5", "effect proximity off"}) {
        EXPECT_GT(session.reading("exact"), 0) << change;
        session.run(change);
        session.advance();  // stands still
        EXPECT_EQ(session.check(), nullptr) << change;
        EXPECT_TRUE(session.canCheck()) << change;
        EXPECT_EQ(faultOf(session, "expect missing = 0"),
                  "Pairs are verified after the next frame: run \"step\".");
        step(session, 1);
        EXPECT_EQ(session.reading("missing"), 0) << change;
    }
}

TEST(Check, SaysNothingOfASceneThatHasJustBegun) {
    Session session = checkedSession();
    session.run("restart");
    EXPECT_EQ(session.check(), nullptr);
    session.run("effect pairs off");
    EXPECT_FALSE(session.canCheck());
}

TEST(Check, LooksAtTheLastFrameAtOnce) {
    Session session = checkedSession();
    const double exact = session.reading("exact");
    session.run("check off");
    EXPECT_EQ(session.check(), nullptr);
    session.run("check on");
    EXPECT_EQ(session.reading("exact"), exact);
    EXPECT_EQ(session.reading("missing"), 0);
}

TEST(Check, KnowsNoPairsOfBodiesThatWereRemoved) {
    for (const char* broadphase : {"hash", "dbvt"}) {
        Session session = checkedSession();
        session.run(std::string("broadphase ") + broadphase);
        step(session, 1);
        const double all = session.reading("pairs");
        session.run("box 300 200 500 400");
        session.run("delete");
        EXPECT_EQ(session.check(), nullptr);
        std::vector<PairKey> pairs;
        session.stage().listPairs(pairs);
        EXPECT_LT(pairs.size(), all) << broadphase;
        EXPECT_GT(pairs.size(), 0U) << broadphase;
        EXPECT_EQ(session.reading("pairs"), pairs.size()) << broadphase;
        for (const PairKey pair : pairs) {
            EXPECT_TRUE(session.stage().contains(firstOf(pair)) &&
                        session.stage().contains(secondOf(pair)))
                << broadphase;
        }
        step(session, 5);
        EXPECT_EQ(session.reading("missing"), 0) << broadphase;
        session.run("box 0 0 800 600");
        session.run("delete");
        EXPECT_EQ(session.reading("bodies"), 0) << broadphase;
        EXPECT_EQ(session.reading("pairs"), 0) << broadphase;
    }
}

}  // namespace
}  // namespace hashphase::demos
