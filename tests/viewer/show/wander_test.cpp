// SPDX-License-Identifier: Zlib
//
// `hashphase wander` as it is typed, without a window.

#include <demos/console/format.hpp>
#include <demos/scenes/file_bytes.hpp>
#include <demos/viewer/show/wander.hpp>
#include <demos/viewer/show/window.hpp>
#include <tests/demos/interruptible.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <unistd.h>

namespace hashphase::demos {
namespace {

using nlohmann::json;
using Words = std::vector<std::string>;

struct Outcome {
    int code;
    std::string out;
    std::string err;
};

class Wander : public testing::Test {
protected:
    /// The words of a line, and others that may have spaces in them.
    static Outcome typed(const std::string& line, const Words& others = {}) {
        std::istringstream all(line);
        Words arguments;
        for (std::string word; all >> word;) {
            arguments.push_back(word);
        }
        arguments.insert(arguments.end(), others.begin(), others.end());
        std::ostringstream out;
        std::ostringstream err;
        const int code = runSingleCommand(arguments, wanderCommand(), {out, err, false, "wander"});
        return {code, out.str(), err.str()};
    }
    static Outcome run(const std::string& line, const Words& others = {}) {
        return typed("--headless --quiet " + line, others);
    }

    /// What it cannot do, and says so.
    static std::string faultOf(const std::string& line, const Words& others = {}) {
        const Outcome outcome = typed("--headless " + line, others);
        EXPECT_EQ(outcome.code, kExitUsage) << line;
        return outcome.err;
    }

    static void expectIn(const std::string& text, const std::string& part) {
        EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
    }

    [[nodiscard]] std::string file(const std::string& name, const std::string& text = {}) const {
        return text.empty() ? folder_.file(name) : folder_.write(name, text);
    }
    [[nodiscard]] json numbersOf(const std::string& line, const Words& others = {}) const {
        EXPECT_EQ(run("--json " + file("n.json") + " " + line, others).code, kExitOk) << line;
        return json::parse(std::ifstream(file("n.json")));
    }
    void expectReplayed(const std::string& recording, int frames) const {
        const Outcome again = run("--replay " + recording);
        EXPECT_EQ(again.code, kExitOk);
        EXPECT_EQ(again.out, "replay: all " + withThousands(static_cast<std::uint64_t>(frames)) +
                                 " frames are the same, to the last bit\n");
    }
    /// Captured boxes of 40 bodies.
    [[nodiscard]] std::string boxes() const {
        run("--objects 40 --frames 1", {"--do", "capture " + file("boxes.aabbs") + " 3"});
        return file("boxes.aabbs");
    }

private:
    TemporaryFolder folder_;
};

TEST_F(Wander, TellsThePhasesOfAFrame) {
    const Outcome told = run("--objects 300 --frames 20");
    EXPECT_EQ(told.code, kExitOk) << told.err;
    for (const char* word :
         {"stand", "pair", "culling", "total", "p95", "worst", "300 bodies", "20 frames"}) {
        expectIn(told.out, word);
    }
}

TEST_F(Wander, TellsTheMedianOfAllFramesButTheFirst) {
    expectIn(run("--objects 3000 --frames 5 --json " + file("n.json")).out,
             "medians of the last 4 frames");
    const json numbers = json::parse(std::ifstream(file("n.json")));
    EXPECT_GE(numbers["readings"]["p95"], numbers["readings"]["milliseconds"]);
    for (const json& phase : numbers["phases"]) {
        EXPECT_GE(phase["p95"], phase["milliseconds"]);
        EXPECT_GE(phase["worst"], phase["p95"]);
    }
}

TEST_F(Wander, TellsTheTimesOfTheFormerBroadphaseAfterASwap) {
    const std::string script = file("swap.script", "step 5\nbroadphase dbvt\nstep 5\n");
    EXPECT_EQ(run("--objects 300 --script " + script + " --json " + file("n.json")).code, kExitOk);
    const json numbers = json::parse(std::ifstream(file("n.json")));
    EXPECT_GT(numbers["readings"]["millisecondsBefore"], 0);
    EXPECT_TRUE(numbers["phases"].contains("find pairs"));
    EXPECT_FALSE(numbers["phases"].contains("pair")) << "is the former broadphase's";
    Session session({.name = "wander", .file = {}, .objects = 300, .seed = 1});
    const auto told = [&session] {
        std::ostringstream out;
        session.advance();
        session.advance();
        tellPhases(session, false, out);
        return out.str();
    };
    EXPECT_EQ(told().find("before"), std::string::npos);
    session.run("broadphase dbvt");
    const std::string both = told();
    expectIn(both, "medians of the last frame\ndbvt ");
    expectIn(both, " ms, before: hash ");
    expectIn(both, "pair                        - ms");
}

TEST_F(Wander, ListsScenesKeysCommandsEffectsAndReadings) {
    const Outcome list = typed("--list");
    EXPECT_EQ(list.code, kExitOk);
    for (const char* word :
         {"wander", "bullet-storm", "F12", "pick X Y", "\n  motion, terrain, pairs, ",
          "\n  tunnelled           number of times ",
          "\n  width               width of the picture [pixels]\n"}) {
        expectIn(list.out, word);
    }
    for (const Reading& reading : readings()) {
        EXPECT_FALSE(reading.help.empty()) << reading.name;
    }
}

TEST_F(Wander, FailsWhereAScriptExpectsWhatIsNotSo) {
    const auto play = [this](const std::string& text) {
        return run("--objects 50 --script " + file("script", text));
    };
    EXPECT_EQ(play("step 3\nexpect frame = 3\n").code, kExitOk);
    const Outcome failed = play("step 3\nexpect frame = 4\n");
    EXPECT_EQ(failed.code, kExitCheckFailed);
    EXPECT_EQ(failed.out, "frame 3: frame is 3, expected = 4\n");
    const Outcome refused = play("step 3\nexpct frame = 4\n");
    EXPECT_EQ(refused.code, kExitUsage);
    expectIn(refused.err, "script:2: There is no command 'expct'");
}

TEST_F(Wander, EndsWhereACommandHasPausedIt) {
    const auto after = [](const std::string& command) {
        return run("--objects 50 --frames 100 --time-limit 20", {"--do", command});
    };
    const Outcome paused = after("pause");
    EXPECT_EQ(paused.code, kExitOk);
    EXPECT_EQ(paused.err, "hashphase: a command paused the scene after 0 of 100 frames.\n");
    const Outcome stepped = after("step 5");
    expectIn(stepped.err, "after 5 of 100 frames");
    expectIn(stepped.out, "pairs after 5 frames");
    const Outcome stopped = after("step 500");
    EXPECT_EQ(stopped.err, "");
    expectIn(stopped.out, "pairs after 100 frames");
}

TEST_F(Wander, SaysWhereAScriptWasStopped) {
    struct Case {
        const char* script;
        const char* timeLimit;
        int code;
        const char* verdict;
    };
    for (const auto& [script, timeLimit, code, verdict] :
         {Case{"step 1000000\nexpect bodies = 5\n", "0.3", kExitCheckFailed,
               "stopped at line 1 of 2"},
          Case{"# a comment\nstep 1000000\n", "0.3", kExitCheckFailed, "stopped at line 2 of 2"},
          Case{"step 2\nquit\nexpect bodies = 5\n", "60", kExitOk, "stopped at line 2 of 3"},
          Case{"step 2\nexpect bodies = 300\n", "60", kExitOk, "all expectations hold"}}) {
        const Outcome ended = run(std::string("--objects 300 --time-limit ") + timeLimit +
                                  " --script " + file("script", script));
        EXPECT_EQ(ended.code, code) << script;
        EXPECT_EQ(ended.out, std::string("script: ") + verdict + "\n");
    }
}

TEST_F(Wander, SaysHowFarAReplayHasCome) {
    const std::string recording = file("r.json");
    run("--objects 100 --frames 70 --record " + recording);
    const Outcome cut = run("--replay " + recording + " --time-limit 1e-9");
    EXPECT_EQ(cut.code, kExitCheckFailed);
    EXPECT_EQ(cut.out, "replay: compared 0 of 70 frames\n");
    expectReplayed(recording + " --time-limit 60", 70);
}

TEST_F(Wander, WritesPicturesRecordingsAndNumbers) {
    const json numbers =
        numbersOf("--objects 100 --frames 30 --size 200x100 --threads 2 --screenshot " +
                      file("a.png") + " --record " + file("a.json"),
                  {"--do", "camera free", "--do", "effect zones on"});
    EXPECT_GT(std::filesystem::file_size(file("a.png")), 1000U);
    EXPECT_EQ(numbers["readings"]["frame"], 30);
    EXPECT_EQ(numbers["readings"]["bodies"], 100);
    EXPECT_TRUE(numbers["readings"]["neighbours"].is_null());
    EXPECT_TRUE(numbers["phases"].contains("stand"));
    expectReplayed(file("a.json"), 30);
}

// A scene file of the seed 7.
constexpr const char* kSceneOfSeed7 =
    R"({"scene": {"objects": 60, "seed": 7}, "effects": {"motion": true, "pairs": true}})";

TEST_F(Wander, TellsWhichSceneItsNumbersAreOf) {
    const std::string scene = file("scene.json", kSceneOfSeed7);
    const std::string recording = boxes();
    struct Case {
        std::string options;
        json scene, file, objects, seed;
    };
    for (const auto& [options, name, path, objects, seed] :
         {Case{"--seed 5", "wander", nullptr, 30'000, 5},
          Case{"--scene pile --objects 50", "pile", nullptr, 50, 1},
          Case{"--file " + scene, nullptr, scene, 60, 7},
          Case{"--file " + recording, nullptr, recording, 40, nullptr}}) {
        const json numbers = numbersOf("--frames 2 " + options, {"--do", "broadphase dbvt"});
        EXPECT_EQ(numbers["scene"], name) << options;
        EXPECT_EQ(numbers["file"], path) << options;
        EXPECT_EQ(numbers["objects"], objects) << options;
        EXPECT_EQ(numbers["seed"], seed) << options;
        EXPECT_EQ(numbers["broadphase"], "dbvt");
    }
}

TEST_F(Wander, TakesTheSeedThatIsAskedForBeforeASceneFilesOwn) {
    const std::string scene = "--frames 3 --file " + file("scene.json", kSceneOfSeed7);
    const auto hashOf = [&](const std::string& options) {
        return numbersOf(scene + options)["readings"]["hash"];
    };
    EXPECT_EQ(hashOf(""), hashOf(" --seed 7"));
    EXPECT_NE(hashOf(""), hashOf(" --seed 1"));
    hashOf(" --record " + file("r.json"));
    expectReplayed(file("r.json"), 3);
}

TEST_F(Wander, RunsOnUntilBoxesAreCaptured) {
    const std::string path = file("captured.aabbs");
    const auto capture = [&](const std::string& options) {
        return run("--objects 40 --frames 2 " + options, {"--do", "capture " + path + " 5"});
    };
    const Outcome cut = capture("--time-limit 1e-9");
    EXPECT_EQ(cut.code, kExitCheckFailed);
    EXPECT_TRUE(cut.out.starts_with(path + " is not written: the run ends after 0 of 5 frames.\n"))
        << cut.out;
    EXPECT_FALSE(std::filesystem::exists(path));
    const Outcome whole = capture("");
    EXPECT_EQ(whole.code, kExitOk);
    EXPECT_TRUE(whole.out.starts_with("wrote the boxes of 5 frames to " + path)) << whole.out;
}

TEST_F(Wander, HasNoSeedForARecordingOfBoxes) {
    const std::string path = boxes();
    EXPECT_EQ(faultOf("--file " + path + " --seed 3"),
              "hashphase: --seed is for scenes; " + path + " is a recording of boxes.\n");
}

TEST_F(Wander, RefusesOptionsThatWouldBeIgnored) {
    const std::string recording = file("r.json");
    run("--objects 40 --frames 3 --record " + recording);
    const std::string script = file("script", "step 1\n");
    for (const std::string& ignored :
         {std::string("--objects 7"), std::string("--seed 9"), std::string("--scene pile"),
          std::string("--do step"), "--script " + script, std::string("--frames 3"),
          std::string("--file a.json")}) {
        expectIn(faultOf("--replay " + recording + " " + ignored),
                 ignored.substr(0, ignored.find(' ')));
    }
    expectIn(faultOf("--frames 3 --script " + script), "--frames");
}

TEST_F(Wander, FindsOutBeforeItRunsWhereNothingCanBeWritten) {
    for (const std::string option : {"--record", "--json", "--screenshot"}) {
        const std::string marker = file("ran" + option);
        const Outcome refused = run("--objects 50 --frames 5 " + option + " /nowhere/a.json",
                                    {"--do", "save " + marker});
        EXPECT_EQ(refused.code, kExitUsage);
        EXPECT_EQ(refused.err,
                  "hashphase: /nowhere/a.json cannot be written: No such file or directory.\n");
        EXPECT_EQ(refused.out, "");
        EXPECT_FALSE(std::filesystem::exists(marker)) << option;
    }
}

TEST_F(Wander, LeavesAPictureAsItIsWhereItCannotBeTaken) {
    const std::string picture = file("kept.png", "what it was");
    const Outcome refused = typed("--objects 10 --screenshot " + picture);
    EXPECT_EQ(refused.code, kExitUsage);
    expectIn(refused.err, "--screenshot is for --headless");
    EXPECT_EQ(readFile(picture), "what it was");
}

// A folder is no place for a picture.
TEST_F(Wander, KeepsWhatWasPlayedUntilAPictureCannotBeWritten) {
    const std::string script =
        file("fault.script", "step 7\nscreenshot " + file("") + "\nstep 7\n");
    const Outcome cut = run("--objects 50 --script " + script + " --record " + file("kept.json") +
                            " --json " + file("n.json"));
    EXPECT_EQ(cut.code, kExitUsage);
    EXPECT_EQ(cut.out, "") << "of a script that was not run to its end there is no verdict";
    expectIn(cut.err, file("") + " is a folder, not a file.");
    EXPECT_EQ(json::parse(std::ifstream(file("n.json")))["readings"]["frame"], 7);
    expectReplayed(file("kept.json"), 7);
}

TEST_F(Wander, NamesEachFileThatCannotBeWrittenAndWritesTheOthers) {
    const std::string script = file("full.script", "step 2\nscreenshot " + file("") + "\n");
    // Beside another fault, and where nothing else is wrong.
    for (const auto& [options, frames] :
         {std::pair{"--script " + script, 2}, std::pair{std::string("--frames 3"), 3}}) {
        const Outcome cut =
            run("--objects 50 --record /dev/full --json " + file("n.json") + " " + options);
        EXPECT_EQ(cut.code, kExitUsage);
        expectIn(cut.err, "/dev/full cannot be written");
        if (frames == 2) {
            expectIn(cut.err, file("") + " is a folder, not a file.");
        }
        EXPECT_EQ(json::parse(std::ifstream(file("n.json")))["readings"]["frame"], frames);
    }
}

// To a file that a command has written during the run, too.
TEST_F(Wander, WritesItsFilesAtTheEnd) {
    for (const char* name : {"r.json", "n.json"}) {
        const Outcome whole =
            run("--objects 50 --frames 20 --record " + file("r.json") + " --json " + file("n.json"),
                {"--do", "save " + file(name)});
        EXPECT_EQ(whole.code, kExitOk) << whole.err;
        EXPECT_EQ(json::parse(std::ifstream(file("n.json")))["readings"]["frame"], 20);
        expectReplayed(file("r.json"), 20);
    }
}

TEST_F(Wander, EndsWithWhatWasPlayedWhenItIsInterrupted) {
    std::atomic<bool> isOver = false;
    std::thread presser([&isOver, afterAFrame = file("first.aabbs")] {
        while (!std::filesystem::exists(afterAFrame)) {
            if (isOver) {
                return;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        kill(getpid(), SIGINT);
    });
    const Outcome cut = run("--objects 50 --frames 1000000000 --time-limit 60 --record " +
                                file("kept.json") + " --json " + file("n.json"),
                            {"--do", "capture " + file("first.aabbs") + " 1"});
    isOver = true;
    presser.join();
    EXPECT_EQ(cut.code, 130);
    expectIn(cut.out, "\nThe run was interrupted: what it measured until then is here.\n");
    const int frames = json::parse(std::ifstream(file("n.json")))["readings"]["frame"];
    ASSERT_GT(frames, 0);
    expectReplayed(file("kept.json"), frames);
}

TEST_F(Wander, SaysWhatIsWrong) {
    EXPECT_EQ(faultOf("--size 10x10"),
              "hashphase: --size is a width and a height of 16 to 8,192 pixels, like 1280x800, "
              "not '10x10'.\n");
    expectIn(faultOf("--size 8193x100 --frames 1"), "of 16 to 8,192 pixels");
    expectIn(faultOf("", {"--do", "size 100 8193"}), "from 16 to 8192, not '8193'");
    expectIn(faultOf("--scene wandr"), "hashphase: There is no scene 'wandr'; did you ");
    EXPECT_EQ(faultOf("--file a.txt"),
              "hashphase: a.txt is neither a scene file (.json) nor a recording of boxes "
              "(.aabbs).\n");
    for (const char* nothing : {" \r\n", "# a comment\n"}) {
        EXPECT_EQ(faultOf("--script " + file("nothing", nothing)),
                  "hashphase: " + file("nothing") + " contains no command.\n");
    }
    expectIn(faultOf("--objects 2e6"), "from 1 to 1,000,000");
    expectIn(faultOf("", {"--do", ""}), "--do: the value is empty");
    expectIn(faultOf("--replay " + file("empty", "{}")), "cannot be read as a recording");
}

// --- Frames a second -----------------------------------------------------------------------------

TEST(FrameRate, LeavesOutTheFirstSecond) {
    FrameRate rate;
    rate.note(0.25);
    rate.note(0.75);
    for (int frame = 0; frame <= 120; ++frame) {
        rate.note(1.5 + frame / 60.0);
    }
    ASSERT_TRUE(rate.perSecond());
    EXPECT_NEAR(*rate.perSecond(), 60, 1e-9);
}

TEST(FrameRate, IsNoneWhereNothingWasShownAfterIt) {
    FrameRate rate;
    EXPECT_FALSE(rate.perSecond());
    for (int frame = 0; frame < 60; ++frame) {
        rate.note(frame / 60.0);
    }
    EXPECT_FALSE(rate.perSecond());
    rate.note(1.25);
    EXPECT_FALSE(rate.perSecond());
    rate.note(1.5);
    EXPECT_EQ(rate.perSecond(), 4);
}

}  // namespace
}  // namespace hashphase::demos
