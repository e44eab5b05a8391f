// SPDX-License-Identifier: Zlib
//
// `hashphase wander` as it is typed, without a window.

#include <demos/scenes/file_bytes.hpp>
#include <demos/viewer/show/wander.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace hashphase::demos {
namespace {

struct Outcome {
    int code;
    std::string out;
    std::string err;
};

Outcome typed(const std::vector<std::string>& arguments) {
    std::ostringstream out;
    std::ostringstream err;
    const int code = runSingleCommand(arguments, wanderCommand(), {out, err, false, "wander"});
    return {code, out.str(), err.str()};
}

class Wander : public testing::Test {
protected:
    [[nodiscard]] std::string file(const std::string& name, const std::string& text = {}) const {
        return text.empty() ? folder_.file(name) : folder_.write(name, text);
    }

private:
    TemporaryFolder folder_;
};

TEST_F(Wander, TellsThePhasesOfAFrame) {
    const Outcome run = typed({"--headless", "--objects", "300", "--frames", "20", "--quiet"});
    EXPECT_EQ(run.code, kExitOk) << run.err;
    for (const char* word : {"stand", "pair", "culling", "together", "300 bodies", "20 frames"}) {
        EXPECT_NE(run.out.find(word), std::string::npos) << word << '\n' << run.out;
    }
}

TEST_F(Wander, TellsTheMedianOfAllFramesButTheFirst) {
    const std::string numbers = file("short.json");
    const Outcome run =
        typed({"--headless", "--objects", "3000", "--frames", "5", "--quiet", "--json", numbers});
    EXPECT_NE(run.out.find("medians of the last 4 frames"), std::string::npos) << run.out;
    const auto json = nlohmann::json::parse(std::ifstream(numbers));
    EXPECT_GE(json["readings"]["p95"], json["readings"]["milliseconds"]);
    for (const auto& phase : json["phases"]) {
        EXPECT_GE(phase["p95"], phase["milliseconds"]);
    }
}

TEST_F(Wander, ListsScenesKeysAndCommands) {
    const Outcome run = typed({"--list"});
    EXPECT_EQ(run.code, kExitOk);
    for (const char* word : {"wander", "bullet-storm", "F12", "pick X Y", "tunnelled"}) {
        EXPECT_NE(run.out.find(word), std::string::npos) << word;
    }
}

TEST_F(Wander, FailsWhereAScriptExpectsWhatIsNotSo) {
    const std::string right = file("right", "step 3\nexpect frame = 3\n");
    const std::string wrong = file("wrong", "step 3\nexpect frame = 4\n");
    const std::string broken = file("broken", "step 3\nexpct frame = 4\n");
    EXPECT_EQ(typed({"--headless", "--objects", "50", "--script", right}).code, kExitOk);
    const Outcome failed = typed({"--headless", "--objects", "50", "--script", wrong});
    EXPECT_EQ(failed.code, kExitCheckFailed);
    EXPECT_EQ(failed.out, "frame 3: frame is 3, but was to be = 4\n");
    const Outcome refused = typed({"--headless", "--objects", "50", "--script", broken});
    EXPECT_EQ(refused.code, kExitUsage);
    EXPECT_NE(refused.err.find("broken:2: There is no command 'expct'"), std::string::npos)
        << refused.err;
}

TEST_F(Wander, EndsWhereACommandHasPausedIt) {
    const auto runOf = [](const std::string& command) {
        return typed({"--headless", "--objects", "50", "--frames", "100", "--quiet", "--time-limit",
                      "20", "--do", command});
    };
    const Outcome paused = runOf("pause");
    EXPECT_EQ(paused.code, kExitOk);
    EXPECT_EQ(
        paused.err,
        "hashphase: the scene stands still after 0 of 100 frames, because a command has paused "
        "it.\n");
    const Outcome stepped = runOf("step 5");
    EXPECT_NE(stepped.err.find("after 5 of 100 frames"), std::string::npos) << stepped.err;
    EXPECT_NE(stepped.out.find("pairs after 5 frames"), std::string::npos) << stepped.out;
    const Outcome stopped = runOf("step 500");
    EXPECT_EQ(stopped.err, "");
    EXPECT_NE(stopped.out.find("pairs after 100 frames"), std::string::npos) << stopped.out;
}

TEST_F(Wander, SaysWhereAScriptWasStopped) {
    const auto runOf = [this](const std::string& text) {
        return typed({"--headless", "--objects", "300", "--quiet", "--time-limit", "0.3",
                      "--script", file("cut", text)});
    };
    const Outcome cut = runOf("step 1000000\nexpect bodies = 5\n");
    EXPECT_EQ(cut.code, kExitCheckFailed);
    EXPECT_EQ(cut.out, "script: stopped at line 1 of 2\n");
    const Outcome cutInTheLast = runOf("# a comment\nstep 1000000\n");
    EXPECT_EQ(cutInTheLast.code, kExitCheckFailed);
    EXPECT_EQ(cutInTheLast.out, "script: stopped at line 2 of 2\n");
    const Outcome left = runOf("step 2\nquit\nexpect bodies = 5\n");
    EXPECT_EQ(left.code, kExitOk);
    EXPECT_EQ(left.out, "script: stopped at line 2 of 3\n");
    const Outcome whole = runOf("step 2\nexpect bodies = 300\n");
    EXPECT_EQ(whole.code, kExitOk);
    EXPECT_EQ(whole.out, "script: all expectations hold\n");
}

TEST_F(Wander, SaysHowFarAReplayHasCome) {
    const std::string recording = file("r.json");
    typed({"--headless", "--objects", "100", "--frames", "70", "--quiet", "--record", recording});
    const Outcome cut =
        typed({"--headless", "--quiet", "--replay", recording, "--time-limit", "1e-9"});
    EXPECT_EQ(cut.code, kExitCheckFailed);
    EXPECT_EQ(cut.out, "replay: compared 0 of 70 frames\n");
    const Outcome whole =
        typed({"--headless", "--quiet", "--replay", recording, "--time-limit", "60"});
    EXPECT_EQ(whole.code, kExitOk);
    EXPECT_EQ(whole.out, "replay: all 70 frames are the same, to the last bit\n");
}

TEST_F(Wander, WritesPicturesRecordingsAndNumbers) {
    const std::string picture = file("a.png");
    const std::string recording = file("a.json");
    const std::string numbers = file("n.json");
    const Outcome run =
        typed({"--headless", "--objects", "100", "--frames", "30", "--size", "200x100", "--do",
               "camera free", "--do", "effect zones on", "--screenshot", picture, "--record",
               recording, "--json", numbers, "--threads", "2"});
    EXPECT_EQ(run.code, kExitOk) << run.err;
    EXPECT_GT(std::filesystem::file_size(picture), 1000U);
    const auto json = nlohmann::json::parse(std::ifstream(numbers));
    EXPECT_EQ(json["readings"]["frame"], 30);
    EXPECT_EQ(json["readings"]["bodies"], 100);
    EXPECT_TRUE(json["readings"]["neighbours"].is_null());
    EXPECT_TRUE(json["phases"].contains("stand"));
    const Outcome again = typed({"--headless", "--quiet", "--replay", recording});
    EXPECT_EQ(again.code, kExitOk);
    EXPECT_EQ(again.out, "replay: all 30 frames are the same, to the last bit\n");
}

// A scene file of the seed 7.
constexpr const char* kSceneOfSeed7 =
    R"({"scene": {"objects": 60, "seed": 7}, "effects": {"motion": true, "pairs": true}})";

TEST_F(Wander, TellsWhichSceneItsNumbersAreOf) {
    const std::string numbers = file("n.json");
    const auto numbersOf = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), {"--headless", "--quiet", "--frames", "2", "--json",
                                             numbers, "--do", "broadphase dbvt"});
        EXPECT_EQ(typed(arguments).code, kExitOk);
        return nlohmann::json::parse(std::ifstream(numbers));
    };
    const auto named = numbersOf({"--seed", "5"});
    EXPECT_EQ(named["scene"], "wander");
    EXPECT_TRUE(named["file"].is_null());
    EXPECT_EQ(named["objects"], 30'000);
    EXPECT_EQ(named["seed"], 5);
    EXPECT_EQ(named["broadphase"], "dbvt");
    EXPECT_EQ(numbersOf({"--scene", "pile", "--objects", "50"})["objects"], 50);
    const std::string scene = file("scene.json", kSceneOfSeed7);
    const auto fromFile = numbersOf({"--file", scene});
    EXPECT_TRUE(fromFile["scene"].is_null());
    EXPECT_EQ(fromFile["file"], scene);
    EXPECT_EQ(fromFile["objects"], 60);
    EXPECT_EQ(fromFile["seed"], 7);
    const std::string boxes = file("boxes.aabbs");
    typed({"--headless", "--quiet", "--objects", "40", "--frames", "1", "--do",
           "capture " + boxes + " 3"});
    const auto recorded = numbersOf({"--file", boxes});
    EXPECT_TRUE(recorded["scene"].is_null());
    EXPECT_EQ(recorded["file"], boxes);
    EXPECT_EQ(recorded["objects"], 40);
    EXPECT_TRUE(recorded["seed"].is_null());
}

TEST_F(Wander, TakesTheSeedThatIsAskedForBeforeASceneFilesOwn) {
    const std::string scene = file("scene.json", kSceneOfSeed7);
    const auto hashOf = [&](std::vector<std::string> arguments) {
        const std::string numbers = file("n.json");
        arguments.insert(arguments.begin(), {"--headless", "--quiet", "--file", scene, "--frames",
                                             "3", "--json", numbers});
        EXPECT_EQ(typed(arguments).code, kExitOk);
        return nlohmann::json::parse(std::ifstream(numbers))["readings"]["hash"].get<double>();
    };
    EXPECT_EQ(hashOf({}), hashOf({"--seed", "7"}));
    EXPECT_NE(hashOf({}), hashOf({"--seed", "1"}));
    const std::string recording = file("r.json");
    hashOf({"--record", recording});
    EXPECT_EQ(typed({"--headless", "--quiet", "--replay", recording}).code, kExitOk);
}

TEST_F(Wander, RunsOnUntilBoxesAreCaptured) {
    const std::string boxes = file("boxes.aabbs");
    const auto capture = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), {"--headless", "--quiet", "--objects", "40", "--frames",
                                             "2", "--do", "capture " + boxes + " 5"});
        return typed(arguments);
    };
    const Outcome cut = capture({"--time-limit", "1e-9"});
    EXPECT_EQ(cut.code, kExitCheckFailed);
    EXPECT_TRUE(cut.out.starts_with(boxes + " is not written: the run ends after 0 of 5 frames.\n"))
        << cut.out;
    EXPECT_FALSE(std::filesystem::exists(boxes));
    const Outcome whole = capture({});
    EXPECT_EQ(whole.code, kExitOk);
    EXPECT_TRUE(whole.out.starts_with("wrote the boxes of 5 frames to " + boxes)) << whole.out;
}

TEST_F(Wander, HasNoSeedForARecordingOfBoxes) {
    const std::string boxes = file("boxes.aabbs");
    typed({"--headless", "--quiet", "--objects", "40", "--frames", "1", "--do",
           "capture " + boxes + " 3"});
    EXPECT_EQ(typed({"--headless", "--file", boxes, "--seed", "3"}).err,
              "hashphase: --seed is for scenes; " + boxes + " is a recording of boxes.\n");
    EXPECT_EQ(typed({"--headless", "--file", boxes, "--do", "seed 3"}).err,
              "hashphase: A recording of boxes has no seed.\n");
}

TEST_F(Wander, RefusesOptionsThatWouldBeIgnored) {
    const std::string recording = file("r.json");
    typed({"--headless", "--quiet", "--objects", "40", "--frames", "3", "--record", recording});
    const std::string script = file("script", "step 1\n");
    const auto refuses = [](const std::vector<std::string>& arguments, const std::string& option) {
        const Outcome run = typed(arguments);
        EXPECT_EQ(run.code, kExitUsage) << option;
        EXPECT_NE(run.err.find(option), std::string::npos) << run.err;
    };
    const std::vector<std::pair<std::string, std::string>> ignored{
        {"--objects", "7"},   {"--seed", "9"},   {"--scene", "pile"}, {"--do", "step"},
        {"--script", script}, {"--frames", "3"}, {"--file", "a.json"}};
    for (const auto& [option, value] : ignored) {
        refuses({"--headless", "--replay", recording, option, value}, option);
    }
    refuses({"--headless", "--script", script, "--frames", "3"}, "--frames");
}

TEST_F(Wander, FindsOutBeforeItRunsWhereNothingCanBeWritten) {
    for (const char* option : {"--record", "--json", "--screenshot"}) {
        const std::string marker = file(std::string("ran") + option);
        const Outcome run = typed({"--headless", "--objects", "50", "--frames", "5", "--do",
                                   "save " + marker, option, "/nowhere/a.json"});
        EXPECT_EQ(run.code, kExitUsage);
        EXPECT_EQ(run.err, "hashphase: /nowhere/a.json cannot be written.\n");
        EXPECT_EQ(run.out, "");
        EXPECT_FALSE(std::filesystem::exists(marker)) << option;
    }
}

TEST_F(Wander, LeavesAPictureAsItIsWhereItCannotBeTaken) {
    const std::string picture = file("kept.png", "what it was");
    const Outcome run = typed({"--objects", "10", "--screenshot", picture});
    EXPECT_EQ(run.code, kExitUsage);
    EXPECT_NE(run.err.find("--screenshot is for --headless"), std::string::npos) << run.err;
    EXPECT_EQ(readFile(picture), "what it was");
}

TEST_F(Wander, KeepsWhatWasPlayedUntilAPictureCannotBeWritten) {
    const std::string recording = file("kept.json");
    const std::string numbers = file("kept-numbers.json");
    const std::string folder = std::filesystem::path(recording).parent_path();
    const std::string script = file("fault.script", "step 7\nscreenshot " + folder + "\nstep 7\n");
    const Outcome run = typed({"--headless", "--objects", "50", "--script", script, "--record",
                               recording, "--json", numbers});
    EXPECT_EQ(run.code, kExitUsage);
    EXPECT_EQ(run.out, "") << "of a script that was not run to its end there is no verdict";
    EXPECT_NE(run.err.find("cannot be written"), std::string::npos) << run.err;
    EXPECT_EQ(nlohmann::json::parse(std::ifstream(numbers))["readings"]["frame"], 7);
    const Outcome again = typed({"--headless", "--quiet", "--replay", recording});
    EXPECT_EQ(again.out, "replay: all 7 frames are the same, to the last bit\n");
}

TEST_F(Wander, NamesEachFileThatCannotBeWrittenAndWritesTheOthers) {
    const std::string numbers = file("full-numbers.json");
    const std::string folder = std::filesystem::path(numbers).parent_path();
    const std::string script = file("full.script", "step 2\nscreenshot " + folder + "\n");
    const Outcome run = typed({"--headless", "--objects", "50", "--script", script, "--record",
                               "/dev/full", "--json", numbers});
    EXPECT_EQ(run.code, kExitUsage);
    EXPECT_NE(run.err.find("The picture " + folder + " cannot be written"), std::string::npos)
        << run.err;
    EXPECT_NE(run.err.find("/dev/full cannot be written"), std::string::npos) << run.err;
    EXPECT_EQ(nlohmann::json::parse(std::ifstream(numbers))["readings"]["frame"], 2);
    // The same where nothing else is wrong.
    const Outcome whole = typed({"--headless", "--quiet", "--objects", "50", "--frames", "3",
                                 "--record", "/dev/full", "--json", numbers});
    EXPECT_EQ(whole.code, kExitUsage);
    EXPECT_EQ(nlohmann::json::parse(std::ifstream(numbers))["readings"]["frame"], 3);
}

TEST_F(Wander, SaysWhatIsWrong) {
    const auto faultOf = [](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "--headless");
        const Outcome run = typed(arguments);
        EXPECT_EQ(run.code, kExitUsage);
        return run.err;
    };
    EXPECT_EQ(faultOf({"--size", "10x10"}),
              "hashphase: --size is a width and a height of 16 to 8,192 pixels, as in 1280x800, "
              "not '10x10'.\n");
    EXPECT_NE(faultOf({"--size", "8193x100", "--frames", "1"}).find("of 16 to 8,192 pixels"),
              std::string::npos);
    EXPECT_NE(faultOf({"--do", "size 100 8193"}).find("from 16 to 8192, not '8193'"),
              std::string::npos);
    EXPECT_EQ(faultOf({"--scene", "wandr"}).substr(0, 46),
              "hashphase: There is no scene 'wandr'; did you ");
    EXPECT_EQ(faultOf({"--file", "a.txt"}),
              "hashphase: a.txt is neither a scene file (.json) nor a recording of boxes "
              "(.aabbs).\n");
    for (const char* nothing : {" \r\n", "# a comment\n"}) {
        EXPECT_EQ(faultOf({"--script", file("nothing", nothing)}),
                  "hashphase: " + file("nothing") + " holds no command.\n");
    }
    EXPECT_NE(faultOf({"--objects", "2e6"}).find("from 1 to 1,000,000"), std::string::npos);
    EXPECT_NE(faultOf({"--do", ""}).find("--do: the value is empty"), std::string::npos);
    EXPECT_NE(faultOf({"--replay", file("empty", "{}")}).find("cannot be read as a recording"),
              std::string::npos);
}

}  // namespace
}  // namespace hashphase::demos
