// SPDX-License-Identifier: Zlib
//
// What the viewer writes over its picture.

#include <demos/viewer/show/annotations.hpp>

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <vector>

namespace hashphase::demos {
namespace {

/// A session after these commands, each followed by a frame of the viewer.
Session after(std::initializer_list<const char*> commands) {
    Session session({.name = "wander", .file = {}, .objects = 3000, .seed = 1}, 800, 600);
    session.isPlaying = false;
    for (const char* command : commands) {
        session.run(command);
        do {
            session.advance();
        } while (session.isWaiting());
    }
    return session;
}

std::vector<std::string> textsOf(const std::vector<Badge>& badges) {
    std::vector<std::string> texts;
    for (const Badge& badge : badges) {
        texts.push_back(badge.text);
    }
    return texts;
}

TEST(Badges, SayThatTheFrustumIsFrozenWhileItIs) {
    using Texts = std::vector<std::string>;
    EXPECT_EQ(textsOf(badges(after({"step 1"}))), Texts());
    EXPECT_EQ(textsOf(badges(after({"step 1", "freeze on"}))), Texts{"frustum frozen (F)"});
    EXPECT_EQ(textsOf(badges(after({"step 1", "freeze on", "freeze off"}))), Texts());
}

TEST(Badges, SayWhetherPairsAreRightAboveWhatElseTheySay) {
    const Session session = after({"check on", "freeze on", "step 10"});
    ASSERT_GT(session.reading("exact"), 0);
    const std::vector<Badge> all = badges(session);
    ASSERT_EQ(all.size(), 2U);
    EXPECT_EQ(all[0].text, "all " + std::to_string(session.pairCheck.exact.size()) +
                               " pairs found, and no other");
    EXPECT_EQ(all[1].text, "frustum frozen (F)");
    const std::vector<Badge> waiting = badges(after({"check on"}));
    ASSERT_EQ(waiting.size(), 1U);
    EXPECT_EQ(waiting[0].text, "pairs are verified after the next frame");
}

TEST(Badges, AlertWherePairsAreMissing) {
    Session session = after({"check on", "step 10"});
    EXPECT_FALSE(badges(session).at(0).isAlert);
    session.pairCheck.missing.push_back(session.pairCheck.exact.front());
    EXPECT_TRUE(badges(session).at(0).isAlert);
}

}  // namespace
}  // namespace hashphase::demos
