// SPDX-License-Identifier: Zlib
//
// What the viewer writes over its picture.

#include <demos/console/format.hpp>
#include <demos/viewer/show/annotations.hpp>
#include <tests/viewer/show/play.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

namespace hashphase::demos {
namespace {

/// A session after these commands, each followed by a frame of the viewer.
Session after(std::initializer_list<const char*> commands) {
    Session session({.name = "wander", .file = {}, .objects = 3000, .seed = 1}, 800, 600);
    play(session, commands);
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
                               " pairs found, no false ones");
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

TEST(SwapText, ComparesFramesWithTheFormerBroadphase) {
    EXPECT_EQ(swapText(after({"step 3"})), "");
    const Session session = after({"step 3", "broadphase dbvt", "step 3"});
    EXPECT_EQ(swapText(session), "dbvt " + fixed(session.reading("milliseconds"), 2) +
                                     " ms, before: hash " +
                                     fixed(session.reading("millisecondsBefore"), 2) + " ms");
    Session next = after({"step 3"});
    next.run("broadphase simple");
    EXPECT_EQ(swapText(next).substr(0, 21), "simple, before: hash ");
}

// --- Zones ---------------------------------------------------------------------------------------

TEST(ZoneLabels, CountTheBodiesOfEachZoneAsReadingsDo) {
    EXPECT_TRUE(zoneLabels(after({"camera top", "step 2"})).empty());
    const Session session = after({"camera top", "effect zones on", "step 2"});
    const std::vector<Label> labels = zoneLabels(session);
    const std::span<const InterestZone> zones = session.stage->interestZones();
    ASSERT_EQ(labels.size(), 20U);
    ASSERT_EQ(zones.size(), 20U);
    std::size_t all = 0;
    for (std::size_t i = 0; i < labels.size(); ++i) {
        all += std::stoul(labels[i].text);
        EXPECT_EQ(labels[i].text, std::to_string(zones[i].bodyCount) +
                                      (zones[i].bodyCount == 1 ? " body" : " bodies"));
    }
    EXPECT_EQ(static_cast<double>(all), session.reading("inZones"));
    EXPECT_GT(all, 0U);
}

TEST(ZoneLabels, AreAtTheCentresThatThePictureShows) {
    const Session session = after({"effect zones on", "eye 200 60 390 0 -25", "step 2"});
    const std::vector<Label> labels = zoneLabels(session);
    EXPECT_GT(labels.size(), 2U);
    EXPECT_LT(labels.size(), 20U) << "of those behind the camera or beside it there are none";
    for (const Label& label : labels) {
        // The ray through the pixel passes the centre of one of them.
        const RayRegion<float> ray = session.view().rayThrough(label.middle.cast<double>());
        float nearest = 1e9F;
        for (const InterestZone& zone : session.stage->interestZones()) {
            const Vector3<float> apart = zone.centre - ray.from();
            const Vector3<float> way = ray.direction().normalized();
            nearest = std::min(nearest, (apart - apart.dot(way) * way).norm());
        }
        EXPECT_LT(nearest, 0.1F) << label.text;
    }
}

TEST(ZoneLabels, MakeRoomForThoseOfLargerZones) {
    const auto sizeOf = [](const std::string& text) {
        return Eigen::Vector2f(10 * static_cast<float>(text.size()), 14);
    };
    const std::vector<Label> labels = placedApart({{{100, 100}, "below", 5},
                                                   {{100, 100}, "large", 9},
                                                   {{120, 95}, "above", 5},
                                                   {{110, 105}, "none", 5},
                                                   {{400, 100}, "apart", 1}},
                                                  sizeOf);
    ASSERT_EQ(labels.size(), 4U);
    const auto expectLabel = [&](std::size_t i, const std::string& text, float x, float y) {
        EXPECT_EQ(labels[i].text, text);
        EXPECT_EQ(labels[i].middle, Eigen::Vector2f(x, y)) << text;
    };
    expectLabel(0, "large", 100, 100);
    expectLabel(1, "below", 100, 115);
    expectLabel(2, "above", 120, 80);
    expectLabel(3, "apart", 400, 100);
}

}  // namespace
}  // namespace hashphase::demos
