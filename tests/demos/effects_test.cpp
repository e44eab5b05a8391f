// SPDX-License-Identifier: Zlib
#include <demos/effects/effects_command.hpp>
#include <demos/effects/effects_prices.hpp>
#include <demos/scenes/file_bytes.hpp>
#include <tests/demos/typed.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {
namespace {

Typed runEffectsCommand(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "effects");
    return typed(arguments, std::array{effectsCommand()});
}

bool has(const std::string& text, std::string_view part) {
    return text.find(part) != std::string::npos;
}

EffectsFile smallExample(std::string_view name) {
    for (const ExampleScene& each : exampleScenes()) {
        if (each.name == name) {
            EffectsFile file = parseEffectsFile(each.text, std::string(name));
            file.scene.objects = 300;
            file.scene.domain = 60;
            file.scene.terrain = std::min(file.scene.terrain, 20U);
            return file;
        }
    }
    return {};
}

EffectPrices pricesOf(const EffectsFile& file, std::uint32_t frames) {
    PricingSettings settings;
    settings.frames = frames;
    settings.warmUpFrames = 2;
    return priceEffects(file, settings);
}

TEST(EffectsCommand, PrintsThePriceOfEachEffectAndWhatIsLostWithoutIt) {
    const TemporaryFolder folder;
    const std::string json = folder.file("prices.json");
    const std::string csv = folder.file("prices.csv");
    const std::string html = folder.file("prices.html");
    const Typed output = runEffectsCommand({"--objects", "400", "--frames", "3", "--json", json,
                                            "--csv", csv, "--html", html, "--quiet"});
    EXPECT_EQ(output.exitCode, kExitOk) << output.out << output.err;
    for (const char* name : {"motion", "terrain", "pairs", "response", "picking", "boxSelection",
                             "culling", "proximity", "zones"}) {
        EXPECT_TRUE(has(output.out, "\n" + std::string(name) + " ")) << name;
    }
    EXPECT_TRUE(has(output.out, "what is not declared costs nothing"));
    EXPECT_FALSE(has(output.out, "BROKEN"));
    EXPECT_TRUE(has(readFile(json), "\"schema\": \"hashphase-effects\""));
    EXPECT_EQ(readFile(csv).rfind("effects,frame_ms,", 0), 0U);
    EXPECT_TRUE(has(readFile(html), "The price list"));
}

TEST(EffectsCommand, RunsAFileThatItHasShown) {
    const TemporaryFolder folder;
    const Typed shown = runEffectsCommand({"--scene", "projectiles", "--objects", "200", "--show"});
    EXPECT_EQ(shown.exitCode, kExitOk);
    const std::string path = folder.write("mine.json", shown.out);
    const Typed output = runEffectsCommand({"--file", path, "--frames", "2", "--quiet"});
    EXPECT_EQ(output.exitCode, kExitOk) << output.err;
    EXPECT_TRUE(has(output.out, "200 bodies, motion, pairs, response, sweep"));
}

TEST(EffectsCommand, ListsScenesAndWritesTheSchema) {
    const Typed list = runEffectsCommand({"--list"});
    for (const ExampleScene& each : exampleScenes()) {
        EXPECT_TRUE(has(list.out, each.name));
    }
    EXPECT_EQ(runEffectsCommand({"--schema"}).out, effectsFileSchema());
}

TEST(EffectsCommand, RefusesWhatItCannotRun) {
    const Typed unknown = runEffectsCommand({"--scene", "papr"});
    EXPECT_EQ(unknown.exitCode, kExitUsage);
    EXPECT_TRUE(has(unknown.err, "did you mean 'paper'?")) << unknown.err;
    const TemporaryFolder folder;
    const std::string path =
        folder.write("turning.json", R"({"effects": {"motion": true, "rotation": true}})");
    const Typed turning = runEffectsCommand({"--file", path});
    EXPECT_EQ(turning.exitCode, kExitUsage);
    EXPECT_TRUE(has(turning.err, "Bullet alone simulates it")) << turning.err;
}

TEST(EffectPrices, RunTheSceneWithAndWithoutEachEffect) {
    const EffectsFile file = smallExample("projectiles");
    const EffectPrices prices = pricesOf(file, 30);
    EXPECT_EQ(prices.whole().effects, file.effects.set());
    EXPECT_TRUE(prices.variants[1].effects.isEmpty());
    ASSERT_EQ(prices.prices.size(), 4U);
    for (const PricedVariant& variant : prices.variants) {
        EXPECT_EQ(variant.frameMs.size(), prices.frames);
        EXPECT_EQ(effectsError(onlyThese(file.effects, variant.effects)), "");
    }
    for (const Check& check : prices.checks) {
        EXPECT_TRUE(check.holds) << check.claim << ": " << check.evidence;
    }
    EXPECT_GT(prices.whole().cost[SceneCounter::sweepersStopped], 0U);
    EXPECT_TRUE(has(prices.prices[3].lost, "fly through"));
}

TEST(EffectPrices, FindWhatIsWrongWithoutAnEffect) {
    const EffectsFile file = smallExample("paper");
    const EffectPrices prices = pricesOf(file, 41);
    EffectSet withoutGround = file.effects.set();
    withoutGround.erase(Effect::terrain);
    EXPECT_EQ(prices.whole().offGround, 0);
    EXPECT_GT(prices.variant(withoutGround).offGround, 100);
    EffectSet withoutResponse = file.effects.set();
    withoutResponse.erase(Effect::response);
    EXPECT_LT(prices.whole().interpenetrating,
              0.7 * prices.variant(withoutResponse).interpenetrating);
}

TEST(EffectPrices, TellWhatIsLateByDeclaration) {
    EffectsFile file = smallExample("budget");
    file.scene.domain = 500;
    const EffectPrices prices = pricesOf(file, 45);
    for (const SceneCounter counter : {SceneCounter::agentsLate, SceneCounter::zonesLate,
                                       SceneCounter::radarsLate, SceneCounter::framesCulledLate}) {
        EXPECT_GT(prices.whole().cost[counter], 0U)
            << sceneCounters()[static_cast<std::size_t>(counter)].name;
    }
    EffectSet withoutSleep = file.effects.set();
    withoutSleep.erase(Effect::sleeping);
    EXPECT_LT(prices.whole().cost[SceneCounter::bodiesMoved],
              prices.variant(withoutSleep).cost[SceneCounter::bodiesMoved]);
}

}  // namespace
}  // namespace hashphase::demos
