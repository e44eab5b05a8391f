// SPDX-License-Identifier: Zlib

#include <demos/compare/filled_broadphase.hpp>
#include <demos/viewer/session/stage_queries.hpp>
#include <demos/viewer/stage/paper_stage.hpp>
#include <tests/viewer/session/stages.hpp>

#include <gtest/gtest.h>

#include <BulletCollision/BroadphaseCollision/btSimpleBroadphase.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

namespace hashphase::demos {
namespace {

/// Spheres so close together that many touch in each frame.
EffectsFile throng() {
    EffectsFile file;
    file.scene.objects = 300;
    file.scene.domain = 40;
    file.scene.terrain = 10;
    file.effects =
        effectsOf({Effect::motion, Effect::terrain, Effect::pairs, Effect::response,
                   Effect::picking, Effect::boxSelection, Effect::culling, Effect::proximity});
    constexpr double infinity = std::numeric_limits<double>::infinity();
    file.effects.motion->bounds = {Vector3<double>(1, -infinity, 1),
                                   Vector3<double>(39, infinity, 39)};
    return file;
}

TEST(PaperStage, MovesBodiesInTheSameWayWhoeverFindsThePairs) {
    std::vector<std::unique_ptr<PaperStage>> stages;
    for (const BroadphaseKind& kind : broadphaseKinds()) {
        stages.push_back(std::make_unique<PaperStage>(throng()));
        stages.back()->setBroadphase(kind);
    }
    // The last one goes from one to the next.
    stages.push_back(std::make_unique<PaperStage>(throng()));
    std::size_t pairs = 0;
    for (std::size_t frame = 0; frame < 60; ++frame) {
        stages.back()->setBroadphase(broadphaseKinds()[frame / 4 % broadphaseKinds().size()]);
        for (const auto& stage : stages) {
            stage->step();
            ASSERT_EQ(stage->placesHash(), stages.front()->placesHash())
                << stage->broadphase().name << " in frame " << frame;
            expectPairs(*stage, stage->broadphase().ours || stage->broadphase().name == "simple",
                        std::string(stage->broadphase().name));
        }
        std::vector<PairKey> found;
        stages.front()->listPairs(found);
        pairs += found.size();
    }
    EXPECT_GT(pairs, 60U * 100);
}

TEST(PaperStage, RunsWhatIsDeclaredAlone) {
    PaperStage stage(throng());
    const auto has = [&stage](std::string_view phase) {
        return std::any_of(stage.times().begin(), stage.times().end(),
                           [phase](const PhaseTime& time) { return time.name == phase; });
    };
    stage.step();
    for (const char* phase : {"stand", "pair", "respond", "culling", "proximity"}) {
        EXPECT_TRUE(has(phase)) << phase;
    }
    SceneEffects effects = stage.effects();
    for (const Effect effect :
         {Effect::terrain, Effect::response, Effect::pairs, Effect::culling, Effect::proximity}) {
        effects.remove(effect);
    }
    stage.declare(effects);
    stage.step();
    for (const char* phase : {"stand", "pair", "respond", "culling", "proximity"}) {
        EXPECT_FALSE(has(phase)) << phase;
    }
    EXPECT_TRUE(stage.ground().empty());
}

TEST(PaperStage, GoesOnWithPairsThatWereTakenBackAndWithoutBodiesThatWereRemoved) {
    PaperStage stage(throng());
    SceneEffects all = stage.effects();
    SceneEffects without = all;
    without.remove(Effect::response);
    without.remove(Effect::pairs);
    for (std::uint32_t frame = 0; frame < 40; ++frame) {
        if (frame % 10 == 0) {
            stage.declare(without);
        } else if (frame % 10 == 5) {
            stage.declare(all);
        }
        stage.setBroadphase(kindNamed(frame % 3 == 0 ? "dbvt" : "hash"));
        EXPECT_EQ(stage.remove(std::array{frame}), 1U);
        EXPECT_EQ(stage.remove(std::array{frame}), 0U);
        stage.step();
        if (stage.effects().pairs) {
            expectPairs(stage, frame % 3 != 0, "frame " + std::to_string(frame));
        }
    }
    EXPECT_EQ(stage.size(), 260U);
}

TEST(PaperStage, RefusesToSweepWithPairsOfAnother) {
    PaperStage stage(throng());
    SceneEffects effects = stage.effects();
    effects.declare(Effect::sweep);
    stage.declare(effects);
    EXPECT_THROW(stage.setBroadphase(kindNamed("dbvt")), std::invalid_argument);
    effects.remove(Effect::sweep);
    stage.declare(effects);
    stage.setBroadphase(kindNamed("dbvt"));
    effects.declare(Effect::sweep);
    EXPECT_THROW(stage.declare(effects), std::invalid_argument);
}

SceneEffects withoutMotion(SceneEffects effects) {
    for (const Effect effect : {Effect::response, Effect::terrain, Effect::motion}) {
        effects.remove(effect);
    }
    return effects;
}

TEST(PaperStage, GivesBodiesTheirVelocitiesBackWhenMotionIsDeclaredAgain) {
    const EffectsFile file = throng();
    EffectsFile still = file;
    still.effects = withoutMotion(file.effects);
    PaperStage moving(file);
    PaperStage stopped(file);
    PaperStage stillAtFirst(still);
    stillAtFirst.step();
    stillAtFirst.declare(file.effects);
    for (int frame = 0; frame < 30; ++frame) {
        if (frame % 10 == 0) {
            const std::uint64_t places = stopped.placesHash();
            stopped.declare(withoutMotion(file.effects));
            EXPECT_EQ(stopped.body(5).speed, 0);
            stopped.step();
            EXPECT_EQ(stopped.placesHash(), places);
            stopped.declare(file.effects);
        }
        moving.step();
        stopped.step();
        stillAtFirst.step();
        ASSERT_EQ(stopped.placesHash(), moving.placesHash()) << frame;
        ASSERT_EQ(stillAtFirst.placesHash(), moving.placesHash()) << frame;
    }
    EXPECT_GT(moving.body(5).speed, 0);
}

TEST(PaperStage, PushesOnlyBodiesThatMove) {
    EffectsFile file = throng();
    file.scene.moving = 0.5;
    PaperStage stage(file);
    std::size_t pushed = 0;
    for (std::uint32_t index = 0; index < stage.indexLimit(); ++index) {
        const StageBody before = stage.body(index);
        EXPECT_EQ(stage.push(index, {0, 0, 50}), !before.isStatic);
        EXPECT_EQ(stage.body(index).speed > 0, !before.isStatic);
        pushed += before.isStatic ? 0 : 1;
    }
    EXPECT_GT(pushed, 100U);
    EXPECT_LT(pushed, 200U);
}

TEST(PaperStage, PicksNobodyThroughTheGround) {
    PaperStage stage(throng());
    stage.step();
    std::size_t seen = 0;
    for (std::uint32_t index = 0; index < stage.indexLimit(); ++index) {
        const Vector3<float> middle = stage.body(index).centre;
        EXPECT_TRUE(stage.pick({middle - Vector3<float>(0, 30, 0), middle}).id.isNull()) << index;
        seen += stage.pick({middle + Vector3<float>(0, 2, 0), middle}).id.index == index ? 1 : 0;
    }
    EXPECT_GT(seen, 200U);
    // Nobody hides them where there is no ground.
    stage.declare(withoutMotion(stage.effects()));
    const Vector3<float> middle = stage.body(7).centre;
    EXPECT_FALSE(stage.pick({middle - Vector3<float>(0, 30, 0), middle}).id.isNull());
}

TEST(PaperStage, CountsWhoIsInItsZonesOfInterest) {
    EffectsFile file = throng();
    file.scene.zones = 5;
    PaperStage stage(file);
    stage.step();
    EXPECT_TRUE(stage.interestZones().empty());
    SceneEffects effects = file.effects;
    effects.declare(Effect::zones);
    stage.declare(effects);
    EXPECT_EQ(stage.interestZones().size(), 5U);
    std::size_t all = 0;
    for (std::uint32_t frame = 0; frame < 10; ++frame) {
        stage.remove(std::array{frame});
        stage.step();
        ASSERT_EQ(stage.interestZones().size(), 5U);
        for (const InterestZone& zone : stage.interestZones()) {
            std::size_t within = 0;
            for (std::uint32_t index = 0; index < stage.indexLimit(); ++index) {
                const bool isWithin =
                    (stage.body(index).centre - zone.centre).norm() <= zone.radius;
                within += stage.contains(index) && isWithin ? 1 : 0;
            }
            EXPECT_EQ(zone.bodyCount, within) << frame;
            all += within;
        }
    }
    EXPECT_GT(all, 10U);
    stage.declare(file.effects);
    EXPECT_TRUE(stage.interestZones().empty());
}

// --- The check itself ----------------------------------------------------------------------------

/// Brute force that does not see pairs of a body with index 3.
class BlindBroadphase : public btSimpleBroadphase {
public:
    explicit BlindBroadphase(int size) : btSimpleBroadphase(size) {
        getOverlappingPairCache()->setOverlapFilterCallback(&filter_);
    }

private:
    struct Filter : btOverlapFilterCallback {
        bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override {
            return FilledBroadphase::objectOf(*a) != 3 && FilledBroadphase::objectOf(*b) != 3;
        }
    };
    Filter filter_;
};

TEST(PairCheck, SeesThatPairsAreMissing) {
    constexpr BroadphaseKind kBlind{
        "blind",
        "blind",
        "blind to one body",
        false,
        0,
        true,
        [](const BroadphaseNeeds& needs) -> std::unique_ptr<btBroadphaseInterface> {
            return std::make_unique<BlindBroadphase>(static_cast<int>(needs.objects) + 16);
        }};
    PaperStage stage(throng());
    stage.setBroadphase(kBlind);
    std::size_t missing = 0;
    for (int frame = 0; frame < 30; ++frame) {
        stage.step();
        const PairCheck check = checkPairs(stage);
        for (const PairKey pair : check.missing) {
            EXPECT_TRUE(firstOf(pair) == 3 || secondOf(pair) == 3);
        }
        missing += check.missing.size();
    }
    EXPECT_GT(missing, 0U);
}

// --- The radar -----------------------------------------------------------------------------------

void expectCounts(const Stage& stage) {
    const RadarView& radar = *stage.radar();
    std::vector<std::uint32_t> expected(std::size_t{radar.columns} * radar.rows);
    for (std::uint32_t index = 0; index < stage.indexLimit(); ++index) {
        const Vector3<float> middle = stage.body(index).centre;
        const float column = std::floor((middle.x() - radar.corner.x()) / radar.cellSize);
        const float row = std::floor((middle.z() - radar.corner.y()) / radar.cellSize);
        const bool isSeen = stage.contains(index) && column >= 0 && row >= 0 &&
                            column < static_cast<float>(radar.columns) &&
                            row < static_cast<float>(radar.rows);
        if (isSeen) {
            ++expected[static_cast<std::size_t>(row) * radar.columns +
                       static_cast<std::size_t>(column)];
        }
    }
    ASSERT_EQ(radar.groupCount, 1U);
    EXPECT_TRUE(
        std::equal(radar.counts.begin(), radar.counts.end(), expected.begin(), expected.end()));
    EXPECT_GT(*std::max_element(expected.begin(), expected.end()), 1U);
}

TEST(RadarView, IsAroundTheInterestAsOfWhenTheRadarLooked) {
    SceneEffects effects = throng().effects;
    effects.declare(Effect::radar);
    effects.radar->cellSize = 4;
    effects.radar->columns = 7;
    effects.radar->rows = 5;
    effects.radar->frames = 2;
    PaperStage stage(throng());
    stage.observers().setInterest(Vector3<float>(20, 0, 21));
    stage.step();
    EXPECT_FALSE(stage.radar());
    stage.declare(effects);
    stage.step();
    stage.step();
    ASSERT_TRUE(stage.radar());
    for (int frame = 0; frame < 6; ++frame) {
        const Eigen::Vector2f corner = stage.radar()->corner;
        stage.observers().setInterest(Vector3<float>(9.0F + 5 * static_cast<float>(frame), 3, 15));
        stage.step();
        if (stage.observers().cost()[SceneCounter::radarScans] > 0) {
            EXPECT_NE(stage.radar()->corner, corner);
            expectCounts(stage);
        } else {
            EXPECT_EQ(stage.radar()->corner, corner);
        }
    }
    stage.declare(throng().effects);
    EXPECT_FALSE(stage.radar());
}

// --- Shapes --------------------------------------------------------------------------------------

TEST(BodyShape, IsMetWhereItsSurfaceIs) {
    StageBody body;
    body.shape = StageBody::Shape::sphere;
    body.centre = {10, 0, 0};
    body.size.setConstant(2);
    EXPECT_FLOAT_EQ(*meets(body, {0, 0, 0}, {16, 0, 0}), 0.5F);
    EXPECT_FLOAT_EQ(*meets(body, {10, 1, 0}, {1, 0, 0}), 0);
    EXPECT_FALSE(meets(body, {0, 3, 0}, {20, 0, 0}));
    EXPECT_FALSE(meets(body, {0, 0, 0}, {7, 0, 0}));
    EXPECT_FALSE(meets(body, {0, 0, 0}, {-20, 0, 0}));
    body.shape = StageBody::Shape::box;
    body.size = {1, 2, 3};
    body.orientation = Eigen::AngleAxisf(std::numbers::pi_v<float> / 2, Vector3<float>::UnitZ());
    EXPECT_FLOAT_EQ(*meets(body, {0, 0, 0}, {16, 0, 0}), 0.5F);
    EXPECT_FALSE(meets(body, {0, 1.5F, 0}, {16, 0, 0}));
    EXPECT_LT((boxAround(body).min() - Vector3<float>(8, -1, -3)).norm(), 1e-5F);
}

TEST(BodyShape, OfACapsuleIsRoundAtItsEnds) {
    StageBody body;
    body.shape = StageBody::Shape::capsule;
    body.size = {1, 2, 0};
    const auto from = [&](const Vector3<float>& start, const Vector3<float>& way) {
        return meets(body, start, way);
    };
    EXPECT_FLOAT_EQ(*from({-5, 0, 0}, {10, 0, 0}), 0.4F);
    EXPECT_FLOAT_EQ(*from({0, 7, 0}, {0, -8, 0}), 0.5F);
    EXPECT_FLOAT_EQ(*from({0, 1, 0}, {0, 10, 0}), 0);
    EXPECT_FLOAT_EQ(*from({-5, 2.6F, 0}, {10, 0, 0}), 0.42F);
    EXPECT_FALSE(from({-5, 3.1F, 0}, {10, 0, 0}));
    EXPECT_FALSE(from({-5, 2.9F, 0.9F}, {10, 0, 0})) << "the corner of its box";
    EXPECT_FALSE(from({0.9F, 5, 0.9F}, {0, -10, 0})) << "the edge of its box";
    body.orientation = Eigen::AngleAxisf(std::numbers::pi_v<float> / 2, Vector3<float>::UnitZ());
    EXPECT_FLOAT_EQ(*from({-8, 0, 0}, {10, 0, 0}), 0.5F);
}

TEST(Ground, IsMetFromEitherSideWhereItsNearestTriangleIs) {
    const std::vector<Vector3<float>> roofs{{0, 1, 0}, {4, 1, 0}, {0, 1, 4},
                                            {0, 2, 0}, {4, 2, 0}, {0, 2, 4}};
    EXPECT_FLOAT_EQ(*meets(roofs, {1, 4, 1}, {0, -4, 0}), 0.5F);
    EXPECT_FLOAT_EQ(*meets(roofs, {1, 0, 1}, {0, 4, 0}), 0.25F);
    EXPECT_FALSE(meets(roofs, {1, 4, 1}, {0, -1, 0})) << "ends before";
    EXPECT_FALSE(meets(roofs, {1, 4, 1}, {0, 4, 0})) << "looks away";
    EXPECT_FALSE(meets(roofs, {3, 4, 3}, {0, -4, 0})) << "beside it";
    EXPECT_FALSE(meets(roofs, {1, 4, 1}, {1, 0, 0})) << "along it";
}

}  // namespace
}  // namespace hashphase::demos
