// SPDX-License-Identifier: Zlib
//
// What colours tell: a body has the colour that the legend says.

#include <demos/viewer/show/picture_maker.hpp>
#include <tests/viewer/show/play.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace hashphase::demos {
namespace {

/// A scene that stands still after these commands, and what its colours tell.
struct Coloured {
    explicit Coloured(std::initializer_list<const char*> commands, const char* scene = "wander")
        : session({.name = scene, .file = {}, .objects = 400, .seed = 1}) {
        play(session, {commands.begin(), commands.size()});
        colours.prepare(session);
        legends = colours.legends(session);
    }

    [[nodiscard]] Colour of(std::uint32_t index) const {
        return colours.of(session, index, session.stage->body(index));
    }

    Session session;
    BodyColours colours;
    std::vector<Legend> legends;
};

const Legend::Entry& lastOf(const Legend& legend) {
    return legend.entries.back();
}

TEST(BodyColours, NeedNoLegendWhereTheyOnlyTellBodiesApart) {
    EXPECT_TRUE(Coloured({"colour agents", "step 3"}).legends.empty());
    EXPECT_TRUE(Coloured({"colour cells", "step 3"}).legends.empty());
    EXPECT_TRUE(Coloured({"colour speed", "overlay bodies off", "step 3"}).legends.empty());
}

TEST(BodyColours, TellTheFastestFromTheFirstPictureOn) {
    const Coloured scene({"colour speed", "step 3"});
    const auto limit = scene.session.stage->indexLimit();
    float fastest = 0;
    std::uint32_t who = 0;
    for (std::uint32_t index = 0; index < limit; ++index) {
        const float speed = scene.session.stage->body(index).speed;
        if (scene.session.isVisible(index) && speed > fastest) {
            fastest = speed;
            who = index;
        }
    }
    ASSERT_GT(fastest, 1);
    ASSERT_EQ(scene.legends.size(), 1U);
    EXPECT_EQ(scene.legends[0].title, "speed [m/s]");
    EXPECT_NEAR(std::stof(lastOf(scene.legends[0]).meaning), fastest, 0.06F);
    EXPECT_EQ(scene.of(who), lastOf(scene.legends[0]).colour);
}

TEST(BodyColours, TellLoadsOnceThoughBodiesAndGroundShowThem) {
    const Coloured scene({"cell 60", "colour load", "overlay heat on", "step 3"});
    ASSERT_EQ(scene.legends.size(), 1U);
    const CellLoads& loads = scene.session.loads;
    ASSERT_GT(loads.largest, 8U);
    EXPECT_EQ(lastOf(scene.legends[0]).meaning, std::to_string(loads.largest));
    const auto limit = scene.session.stage->indexLimit();
    std::uint32_t inTheFullest = 0;
    for (std::uint32_t index = 0; index < limit; ++index) {
        const Vector3<float> at = scene.session.stage->body(index).centre;
        if (loads.at(at.x(), at.z()) == loads.largest) {
            ++inTheFullest;
            EXPECT_EQ(scene.of(index), lastOf(scene.legends[0]).colour);
        }
    }
    EXPECT_GE(inTheFullest, loads.largest);
}

TEST(BodyColours, TellTheGroundsLoadsBesideWhatBodiesTell) {
    const Coloured scene({"colour pairs", "overlay heat on", "step 3"});
    ASSERT_EQ(scene.legends.size(), 2U);
    EXPECT_EQ(scene.legends[0].title, "bodies in a column of cells");
    EXPECT_EQ(scene.legends[1].title, "pairs per body");
    EXPECT_EQ(lastOf(scene.legends[1]).meaning, "8 or more");
}

TEST(BodyColours, TellWhoNeverMoves) {
    const Coloured scene({"colour rest", "step 3"}, "static-city");
    ASSERT_EQ(scene.legends.size(), 1U);
    const auto limit = scene.session.stage->indexLimit();
    std::size_t staticCount = 0;
    for (std::uint32_t index = 0; index < limit; ++index) {
        const StageBody body = scene.session.stage->body(index);
        if (body.isStatic) {
            ++staticCount;
            EXPECT_EQ(scene.of(index), scene.legends[0].entries[0].colour);
        } else if (!body.isAsleep) {
            EXPECT_EQ(scene.of(index), scene.legends[0].entries[2].colour);
        }
    }
    EXPECT_GT(staticCount, 100U);
}

}  // namespace
}  // namespace hashphase::demos
