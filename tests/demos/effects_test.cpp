// SPDX-License-Identifier: Zlib
#include <demos/effects/effects_command.hpp>
#include <demos/effects/effects_prices.hpp>
#include <demos/scenes/effects_file.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

namespace hashphase::demos {
namespace {

struct EffectsOutput {
    int exitCode = 0;
    std::string out;
    std::string err;
};

EffectsOutput runEffectsCommand(std::vector<std::string> arguments) {
    std::ostringstream out;
    std::ostringstream err;
    arguments.insert(arguments.begin(), "effects");
    const std::array subcommands{effectsCommand()};
    EffectsOutput output;
    output.exitCode = runProgram(arguments, subcommands, {out, err, false, "hashphase test"});
    output.out = out.str();
    output.err = err.str();
    return output;
}

std::string contentsOf(const std::string& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
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
    const EffectsOutput output = runEffectsCommand({"--objects", "400", "--frames", "3", "--json",
                                                    json, "--csv", csv, "--html", html, "--quiet"});
    EXPECT_EQ(output.exitCode, kExitOk) << output.out << output.err;
    for (const char* name : {"motion", "terrain", "pairs", "response", "picking", "boxSelection",
                             "culling", "proximity", "zones"}) {
        EXPECT_NE(output.out.find("\n" + std::string(name) + " "), std::string::npos) << name;
    }
    EXPECT_NE(output.out.find("what is not declared costs nothing"), std::string::npos);
    EXPECT_EQ(output.out.find("BROKEN"), std::string::npos);
    EXPECT_NE(contentsOf(json).find("\"schema\": \"hashphase-effects\""), std::string::npos);
    EXPECT_EQ(contentsOf(csv).rfind("effects,frame_ms,", 0), 0U);
    EXPECT_NE(contentsOf(html).find("The price list"), std::string::npos);
}

TEST(EffectsCommand, RunsAFileThatItHasShown) {
    const TemporaryFolder folder;
    const std::string path = folder.file("mine.json");
    const EffectsOutput shown =
        runEffectsCommand({"--scene", "projectiles", "--objects", "200", "--show"});
    EXPECT_EQ(shown.exitCode, kExitOk);
    std::ofstream(path) << shown.out;
    const EffectsOutput output = runEffectsCommand({"--file", path, "--frames", "2", "--quiet"});
    EXPECT_EQ(output.exitCode, kExitOk) << output.err;
    EXPECT_NE(output.out.find("200 bodies, motion, pairs, response, sweep"), std::string::npos);
}

TEST(EffectsCommand, ListsScenesAndWritesTheSchema) {
    const EffectsOutput list = runEffectsCommand({"--list"});
    for (const ExampleScene& each : exampleScenes()) {
        EXPECT_NE(list.out.find(each.name), std::string::npos);
    }
    EXPECT_EQ(runEffectsCommand({"--schema"}).out, effectsFileSchema());
}

TEST(EffectsCommand, RefusesWhatItCannotRun) {
    const EffectsOutput unknown = runEffectsCommand({"--scene", "papr"});
    EXPECT_EQ(unknown.exitCode, kExitUsage);
    EXPECT_NE(unknown.err.find("did you mean 'paper'?"), std::string::npos) << unknown.err;
    const TemporaryFolder folder;
    const std::string path = folder.file("turning.json");
    std::ofstream(path) << "{\"effects\": {\"motion\": true, \"rotation\": true}}\n";
    const EffectsOutput turning = runEffectsCommand({"--file", path});
    EXPECT_EQ(turning.exitCode, kExitUsage);
    EXPECT_NE(turning.err.find("Bullet alone simulates it"), std::string::npos) << turning.err;
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
    EXPECT_NE(prices.prices[3].lost.find("fly through"), std::string::npos);
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
