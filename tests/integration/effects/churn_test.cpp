// SPDX-License-Identifier: Zlib
//
// Scenes in which everything is left to chance: what is declared, who takes part in what, who comes and
// who goes. After each frame what was found is what its twins find, which ask the same grid anew.

#include <integration/ai/radar.hpp>
#include <integration/ai/rarest_colour.hpp>
#include <integration/effects/simulation.hpp>
#include <tests/integration/effects/small_scene.hpp>
#include <tests/support/oracles.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

namespace hashphase::test {
namespace {

using Point = Vector3<float>;

class Churn {
public:
    explicit Churn(std::uint64_t seed) : random_(seed) {
        while (simulation_.declared().set().isEmpty()) {
            declareAnything();
        }
        for (int i = 0; i < 30; ++i) {
            addAnybody();
        }
    }

    void playFrame() {
        if (random_.chance(0.12)) {
            declareAnything();
        }
        if (random_.chance(0.3)) {
            addAnybody();
        }
        if (random_.chance(0.3) && !bodies_.empty()) {
            removeAnybody();
        }
        if (random_.chance(0.3) && !bodies_.empty()) {
            simulation_.setPosition(anybody(), anywhere());
        }
        if (random_.chance(0.2)) {
            simulation_.observers().setInterest(anywhere());
        }
        if (random_.chance(0.2) && has(Effect::picking)) {
            checkPick();  // before the frame as well as after
        }
        const std::vector<std::uint32_t> coloursBefore = colours();
        simulation_.advance(kStep);
        ASSERT_EQ(simulation_.validate(), "");
        ASSERT_EQ(simulation_.size(), bodies_.size());
        checkPairs();
        if (!simulation_.declared().set().containsAny(kGridEffects)) {
            return;
        }
        checkWhoIsVisible();
        checkZones();
        checkRadar();
        checkColours(coloursBefore);
        checkPick();
        checkSelection();
    }

    /// How much there was to be compared, by effect.
    [[nodiscard]] const std::map<Effect, std::size_t>& compared() const { return compared_; }

private:
    struct Known {
        EffectSet effects;
        std::uint32_t group;
    };

    [[nodiscard]] bool has(Effect effect) const {
        return simulation_.declared().set().contains(effect);
    }
    [[nodiscard]] Point anywhere() { return random_.pointIn({0, 0, 0}, {20, 3, 20}).cast<float>(); }
    [[nodiscard]] BodyId anybody() {
        const std::uint32_t which = random_.below(static_cast<std::uint32_t>(bodies_.size()));
        return std::next(bodies_.begin(), which)->first;
    }
    [[nodiscard]] EffectSet some(double share) {
        EffectSet effects;
        for (const Effect effect : kAllEffects) {
            if (random_.chance(share)) {
                effects.insert(effect);
            }
        }
        return effects;
    }

    void declareAnything() {
        const SceneEffects before = simulation_.declared();
        SceneEffects effects = smallSceneEffects(some(0.7) & kSimulated);
        if (random_.chance(0.2)) {
            effects.grid.cellSize = 3;
        }
        if (effects.culling && random_.chance(0.5)) {
            effects.culling->margin = random_.chance(0.5) ? 0 : 1;
            effects.culling->restingCameraFrames = 1 + random_.below(3);
        }
        if (effects.proximity && random_.chance(0.5)) {
            effects.proximity->interestRadius = 6;
            effects.proximity->farFrames = 3;
        }
        if (!effectsError(effects).empty()) {
            return;
        }
        simulation_.declare(effects);
        const bool hadGrid = before.set().containsAny(kGridEffects);
        const bool isFiledAnew = !hadGrid || !(before.grid == effects.grid);
        if (isFiledAnew || !before.pairs) {
            pairs_.clear();
        }
        if (effects.zones && !before.zones) {
            for (const Point& center : {Point(10, 1, 10), Point(3, 1, 3)}) {
                const Zone<float> zone{SphereRegion<float>(center, 6)};
                static_cast<void>(simulation_.observers().zones().add(zone));
                static_cast<void>(twinZones_.add(zone));
            }
        } else if (before.zones && !effects.zones) {
            twinZones_ = {};
        }
        if (isFiledAnew) {
            twinZones_.forgetOccupants();
        }
        if (effects.culling && !before.culling) {
            lookSomewhere();
        }
        for (auto& [id, known] : bodies_) {
            known.group = effects.radar && before.radar ? known.group : 0;
        }
    }

    void lookSomewhere() {
        simulation_.observers().setView(
            frustumRegion<float>(smallSceneView().viewProjection(), DepthRange::zeroToOne));
    }

    void addAnybody() {
        Body<float> body;
        body.position = anywhere();
        body.radius = static_cast<float>(random_.between(0.3, 1.5));
        const double speed = random_.chance(0.1) ? 200 : 5;
        body.velocity = random_.pointIn({-speed, 0, -speed}, {speed, 0, speed}).cast<float>();
        body.effects = some(0.75);
        body.group = random_.below(2);
        body.isAsleep = random_.chance(0.2);
        const BodyId id = simulation_.add(body);
        ASSERT_FALSE(bodies_.contains(id));
        bodies_[id] = {body.effects, has(Effect::radar) ? body.group : 0};
        if (has(Effect::proximity)) {
            if (id.index < colours().size()) {
                ASSERT_EQ(colours()[id.index], 0U) << "that of whoever had the index before";
            }
            simulation_.observers().setColour(id.index, random_.below(4));
        }
    }

    void removeAnybody() {
        const BodyId id = anybody();
        simulation_.remove(id);
        bodies_.erase(id);
    }

    [[nodiscard]] std::vector<std::uint32_t> colours() const {
        if (!has(Effect::proximity)) {
            return {};
        }
        const auto colours = simulation_.observers().colours();
        return {colours.begin(), colours.end()};
    }

    /// Those who take part in an effect, as the grid has them.
    [[nodiscard]] std::vector<Placed<float>> participants(Effect effect) const {
        std::vector<Placed<float>> found;
        simulation_.grid().forEach([&](ProxyId id, const Aabb<float>& box) {
            if (takesPart(id, effect)) {
                found.push_back({id, box});
            }
        });
        return found;
    }
    [[nodiscard]] bool takesPart(ProxyId id, Effect effect) const {
        return bodies_.at(simulation_.bodyOf(id)).effects.contains(effect);
    }
    [[nodiscard]] auto filterOf(Effect effect) const {
        return [this, effect](ProxyId id) { return takesPart(id, effect); };
    }

    void checkPairs() {
        if (!has(Effect::pairs)) {
            return;
        }
        const auto [born, died] = simulation_.pairChanges();
        for (const ProxyPair& pair : died) {
            ASSERT_EQ(pairs_.erase(pair), 1U);
        }
        for (const ProxyPair& pair : born) {
            ASSERT_TRUE(pairs_.insert(pair).second);
        }
        ASSERT_EQ(simulation_.pairCount(), pairs_.size());
        if (simulation_.cost()[SceneCounter::sweepsSolved] > 0) {
            return;  // who swept has landed elsewhere since
        }
        const std::vector<ProxyPair> actual(pairs_.begin(), pairs_.end());
        const auto meet = [](const auto& a, const auto& b) { return overlaps(a.box, b.box); };
        const std::vector<Placed<float>> all = participants(Effect::pairs);
        ASSERT_EQ(differences(actual, pairsByBruteForce<float>(all, meet)), "");
        compared_[Effect::pairs] += actual.size();
    }

    void checkWhoIsVisible() {
        if (!has(Effect::culling)) {
            return;
        }
        const Culler<float>& culler = simulation_.observers().culler();
        const bool isLate = simulation_.cost()[SceneCounter::framesCulledLate] > 0;
        std::set<std::uint32_t> mayBeSeen;
        for (const Placed<float>& proxy : participants(Effect::culling)) {
            mayBeSeen.insert(proxy.id.index);
            if (!isLate && culler.frustum().key(proxy.box) >= 0) {
                ASSERT_TRUE(culler.isVisible(proxy.id)) << proxy.id.index;
                ++compared_[Effect::culling];
            }
        }
        culler.forEach([&](std::uint32_t index) { EXPECT_TRUE(mayBeSeen.contains(index)); });
        ASSERT_FALSE(testing::Test::HasFailure());
    }

    void checkZones() {
        if (!has(Effect::zones)) {
            return;
        }
        const ZoneEvents events = simulation_.observers().zoneEvents();
        const auto counts = [&](ZoneId, ProxyId id) { return takesPart(id, Effect::zones); };
        const ZoneEvents expected = twinZones_.update(simulation_.grid(), counts);
        ASSERT_TRUE(std::ranges::equal(events.entered, expected.entered));
        ASSERT_TRUE(std::ranges::equal(events.stayed, expected.stayed));
        ASSERT_TRUE(std::ranges::equal(events.left, expected.left));
        compared_[Effect::zones] += events.entered.size() + events.left.size();
    }

    void checkRadar() {
        if (!has(Effect::radar)) {
            return;
        }
        const RadarEffect& effect = *simulation_.declared().radar;
        const RadarWindow<float> window{
            .center = simulation_.observers().interest().value_or(Point::Zero()),
            .cellSize = static_cast<float>(effect.cellSize),
            .columns = effect.columns,
            .rows = effect.rows,
            .up = effect.up};
        const auto groupOf = [&](ProxyId id) -> std::uint32_t {
            const Known& known = bodies_.at(simulation_.bodyOf(id));
            return known.effects.contains(Effect::radar) ? known.group : effect.groupCount;
        };
        const auto expected =
            twinRadar_.scan(simulation_.grid(), window, effect.groupCount, groupOf);
        const auto counts = simulation_.observers().radarCounts();
        if (!counts.empty()) {  // or nobody has ever taken part
            ASSERT_TRUE(std::ranges::equal(counts, expected));
        }
        compared_[Effect::radar] += counts.size();
    }

    // Those who looked around have the colour that is rarest near them.
    void checkColours(std::vector<std::uint32_t> before) {
        if (!has(Effect::proximity)) {
            return;
        }
        const ProximityEffect& effect = *simulation_.declared().proximity;
        before.resize(simulation_.grid().indexLimit(), 0);
        twinColours_.update(simulation_.grid(), static_cast<float>(effect.radius),
                            effect.colourCount, before, filterOf(Effect::proximity));
        const std::vector<std::uint32_t> now = colours();
        const bool someAreLate = simulation_.cost()[SceneCounter::agentsLate] > 0;
        std::uint64_t late = 0;
        for (const Placed<float>& agent : participants(Effect::proximity)) {
            const Point center = simulation_.position(simulation_.bodyOf(agent.id));
            const bool isFar =
                someAreLate &&
                (center - *simulation_.observers().interest()).norm() > effect.interestRadius;
            late += isFar ? 1 : 0;
            if (!isFar) {
                ASSERT_EQ(now.at(agent.id.index), before.at(agent.id.index)) << agent.id.index;
                ++compared_[Effect::proximity];
            }
        }
        ASSERT_EQ(simulation_.cost()[SceneCounter::agentsLate], late);
    }

    void checkPick() {
        if (!has(Effect::picking)) {
            return;
        }
        const RayRegion<float> ray(anywhere() + Point(0, 20, 0), anywhere() - Point(0, 20, 0));
        const Picked<float> picked = simulation_.pick(ray);
        const Picked<float> expected =
            pickNearest(simulation_.grid(), ray, filterOf(Effect::picking));
        ASSERT_EQ(picked.id, expected.id);
        compared_[Effect::picking] += expected.id.isNull() ? 0 : 1;
    }

    void checkSelection() {
        if (!has(Effect::boxSelection)) {
            return;
        }
        std::vector<ProxyId> selected;
        std::vector<ProxyId> expected;
        simulation_.select(smallSceneView(), {100, 100}, {600, 400}, selected);
        select(simulation_.grid(), smallSceneView(), {100, 100}, {600, 400}, expected,
               Containment::touching, filterOf(Effect::boxSelection));
        ASSERT_EQ(selected, expected);
        compared_[Effect::boxSelection] += expected.size();
    }

    Random random_;
    Simulation<float> simulation_;
    std::map<BodyId, Known> bodies_;

    std::set<ProxyPair> pairs_;
    Zones<float> twinZones_;
    Radar<float> twinRadar_;
    RarestColour<float> twinColours_;
    std::map<Effect, std::size_t> compared_;
};

TEST(EffectChurn, FindsWhatItsTwinsFind) {
    std::map<Effect, std::size_t> compared;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        Churn churn(0x5eed1000 + seed);
        for (int frame = 0; frame < 60; ++frame) {
            SCOPED_TRACE(testing::Message() << "seed " << seed << ", frame " << frame);
            ASSERT_NO_FATAL_FAILURE(churn.playFrame());
        }
        for (const auto& [effect, count] : churn.compared()) {
            compared[effect] += count;
        }
    }
    for (const Effect effect : kAllEffects) {
        if (kGridEffects.contains(effect)) {
            EXPECT_GT(compared[effect], 300U) << nameOf(effect);
        }
    }
}

}  // namespace
}  // namespace hashphase::test
