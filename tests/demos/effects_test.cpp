// SPDX-License-Identifier: Zlib
#include <demos/effects/effects_command.hpp>
#include <demos/effects/effects_prices.hpp>
#include <demos/scenes/file_bytes.hpp>
#include <tests/demos/asked.hpp>
#include <tests/demos/typed.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {
namespace {

Typed runEffectsCommand(const std::vector<std::string>& arguments) {
    return typed(effectsCommand(), arguments);
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

/// As effects.sql leaves them.
struct Priced {
    Measurements measured;
    Findings findings;

    Priced(const EffectsFile& file, std::uint32_t frames) : measured(measure(file, frames)) {
        findings = effectsFindings(measured);
    }

    [[nodiscard]] std::string ask(std::string_view sql) { return asked(measured, sql); }

    /// What is found of it now that some of it was changed.
    [[nodiscard]] Findings findAgain() {
        for (const char* made : {"spreads", "means", "parts", "said", "differences", "prices",
                                 "below_zero", "checks", "figures"}) {
            measured.ask("DROP TABLE " + std::string(made));
        }
        measured.ask("DROP VIEW texts");
        return effectsFindings(measured);
    }

    /// Of the whole scene, or of it without that.
    [[nodiscard]] double mean(const std::string& name, const std::string& without = {}) {
        return std::stod(
            ask("SELECT number FROM means WHERE name = '" + name + "' AND variant = " +
                (without.empty()
                     ? "1"
                     : "(SELECT all_without FROM compared WHERE effect = '" + without + "')")));
    }

private:
    static Measurements measure(const EffectsFile& file, std::uint32_t frames) {
        PricingSettings settings;
        settings.frames = frames;
        settings.warmUpFrames = 2;
        return priceEffects(file, settings);
    }
};

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
    EXPECT_TRUE(has(output.out, "undeclared effects cost nothing"));
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

TEST(EffectsCommand, RunsASceneWithoutEffectsOnce) {
    const TemporaryFolder folder;
    const std::string csv = folder.file("r.csv");
    const Typed output = runEffectsCommand({"--file", folder.write("bare.json", "{}"), "--objects",
                                            "50", "--frames", "2", "--csv", csv, "--quiet"});
    EXPECT_EQ(output.exitCode, kExitOk) << output.err;
    const std::string rows = readFile(csv);
    EXPECT_EQ(std::ranges::count(rows, '\n'), 2) << rows;
    EXPECT_EQ(rows.find(",frame_ms,"), rows.rfind(",frame_ms,")) << rows;
}

TEST(EffectsCommand, HasFewerBodiesAndFramesInAQuickRunUnlessTheyAreGiven) {
    const std::string quick = runEffectsCommand({"--quick", "--show"}).out;
    EXPECT_TRUE(has(quick, "\"objects\": 2000")) << quick;
    EXPECT_TRUE(has(quick, "\"frames\": 60")) << quick;
    const std::string given =
        runEffectsCommand({"--quick", "--show", "--objects", "5000", "--frames", "7"}).out;
    EXPECT_TRUE(has(given, "\"objects\": 5000")) << given;
    EXPECT_TRUE(has(given, "\"frames\": 7")) << given;
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
    EXPECT_TRUE(has(turning.err, "only Bullet simulates it")) << turning.err;
}

TEST(EffectPrices, RunTheSceneWithAndWithoutEachEffect) {
    const EffectsFile file = smallExample("projectiles");
    Priced priced(file, 30);
    EXPECT_EQ(priced.ask("SELECT effects FROM variants WHERE rowid <= 2"),
              namesOf(file.effects.set()) + "; " + namesOf({}));
    EXPECT_EQ(priced.ask("SELECT group_concat(effect, ' ') FROM compared"),
              "motion pairs response sweep");
    EXPECT_EQ(priced.ask("SELECT count(DISTINCT variant), min(n), max(n) FROM (SELECT variant, "
                         "count(DISTINCT frame) AS n FROM frames GROUP BY variant)"),
              priced.ask("SELECT count(*) FROM variants") + " 30 30");
    ASSERT_EQ(priced.findings.sections.at(0).checks.size(), 2U);
    for (const Check& check : priced.findings.sections[0].checks) {
        EXPECT_TRUE(check.holds) << check.claim << ": " << check.evidence;
    }
    EXPECT_EQ(priced.findings.holds, true);
    EXPECT_GT(priced.mean("sweepersStopped"), 0);
    EXPECT_TRUE(has(priced.ask("SELECT lost FROM prices WHERE effect = 'sweep'"), "fly through"));
}

TEST(EffectPrices, DeclareWhatTheVariantsNeed) {
    const SceneEffects effects = smallExample("paper").effects;
    int variants = 0;
    for (const Effect effect : kAllEffects) {
        const EffectSet with = needsOf(effect) | EffectSet{effect};
        if ((effects.set() | with) == effects.set()) {
            const SceneEffects some = onlyThese(effects, with);
            EXPECT_EQ(some.set(), with);
            EXPECT_EQ(effectsError(some), "");
            ++variants;
        }
    }
    EXPECT_GT(variants, 5);
}

TEST(EffectPrices, FindWhatIsWrongWithoutAnEffect) {
    Priced priced(smallExample("paper"), 41);
    EXPECT_EQ(priced.mean("offGround"), 0);
    EXPECT_GT(priced.mean("offGround", "terrain"), 100);
    EXPECT_LT(priced.mean("interpenetrating"), 0.7 * priced.mean("interpenetrating", "response"));
}

TEST(EffectPrices, TellWhatIsLateByDeclaration) {
    EffectsFile file = smallExample("budget");
    file.scene.domain = 500;
    Priced priced(file, 45);
    for (const char* counter : {"agentsLate", "zonesLate", "radarsLate", "framesCulledLate"}) {
        EXPECT_GT(priced.mean(counter), 0) << counter;
    }
    EXPECT_LT(priced.mean("bodiesMoved"), priced.mean("bodiesMoved", "sleeping"));
    const std::string lost = priced.ask("SELECT group_concat(lost, '; ') FROM prices");
    EXPECT_TRUE(has(lost, " are late with proximity; ")) << lost;
    EXPECT_TRUE(has(lost, "no radar; late in ")) << lost;
}

TEST(EffectPrices, SayWhatIsNotAsItMustBe) {
    Priced priced(smallExample("projectiles"), 1);
    priced.measured.ask("UPDATE numbers SET number = 3 WHERE variant = 2 AND name = 'boxesTested'");
    priced.measured.ask("UPDATE results SET differs = 1 WHERE rowid = 1");
    const Findings broken = priced.findAgain();
    EXPECT_EQ(broken.holds, false);
    EXPECT_TRUE(has(broken.verdict, "; A CHECK FAILED, see above"));
    const std::vector<Check>& checks = broken.sections.at(0).checks;
    EXPECT_EQ(checks.at(0).evidence, "not 0: boxesTested with " + namesOf({}) + ";");
    EXPECT_EQ(checks.at(1).evidence.substr(0, 5), "1 of ");
}

// The scene takes 1 ms, without sweeps 2 ms, and without responses as much, more or less.
TEST(EffectPrices, ExplainATimeBelowZeroBesideIt) {
    Priced priced(smallExample("projectiles"), 20);
    priced.measured.ask("UPDATE frames SET ms = 1");
    priced.measured.ask(
        "UPDATE frames SET ms = 2 WHERE variant = (SELECT all_without FROM compared WHERE effect = "
        "'sweep')");
    priced.measured.ask(
        "UPDATE frames SET ms = iif(frame % 4 = 0, 0.5, 1.25) WHERE variant = (SELECT all_without "
        "FROM compared WHERE effect = 'response')");
    const Findings found = priced.findAgain();
    const std::vector<std::string>& onPage = found.sections.at(0).sentences;
    const std::vector<std::string> onTerminal = sentencesOf(found.rows.at("below"));
    for (const char* sentence :
         {"sweep within all, -1.00 ms: a frame takes less time with the effect, because the effect "
          "saves other effects more time than it takes.",
          "response within all, -0.250 ms: less than the variation between frames (-0.250 to 0.500 "
          "ms), so too small to measure."}) {
        EXPECT_EQ(std::ranges::count(onPage, sentence), 1) << sentence;
        EXPECT_EQ(std::ranges::count(onTerminal, sentence), 1) << sentence;
    }
    EXPECT_EQ(onPage.size(), 3U) << "nothing else is below zero";
}

}  // namespace
}  // namespace hashphase::demos
