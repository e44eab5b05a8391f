// SPDX-License-Identifier: Zlib

#include <demos/scenes/input_error.hpp>
#include <demos/viewer/session/script.hpp>
#include <demos/viewer/session/session.hpp>
#include <tests/support/temporary_folder.hpp>
#include <tests/viewer/session/stages.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace hashphase::demos {
namespace {

Session wanderers(std::size_t objects, int width = 1280, int height = 800) {
    return Session({.name = "wander", .file = {}, .objects = objects, .seed = 5}, width, height);
}

Session playBack(const CommandLog& log) {
    Playback playback(log);
    Session session(log.choice);
    for (playback.feed(session); !playback.isDone(session); playback.feed(session)) {
        session.advance();
    }
    return session;
}

/// What a playback says of a session, and whether it is the same.
using Verdict = std::pair<std::string, bool>;
Verdict verdictOf(const Playback& playback, const Session& session) {
    bool isSame = false;
    std::string words = playback.verdict(session, isSame);
    return {words, isSame};
}

const Verdict kAllTheSame{"replay: all 130 frames are the same, to the last bit", true};

/// As recorded, but for one text.
std::string textWhereReplaced(const CommandLog& log, const std::string& what,
                              const std::string& by) {
    std::string text = log.text();
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), by);
}

CommandLog replaced(const CommandLog& log, const std::string& what, const std::string& by) {
    return CommandLog::parse(textWhereReplaced(log, what, by), "recording");
}

TEST(Playback, SaysWhereItIsNotTheSame) {
    Session session = wanderers(100);
    step(session, 70);
    session.run("pose top 200 7 200 439 0 0 0 0 0 0 0 0 0 20 0 0");
    session.run("box 0 0 1280 800");
    session.run("push 3 0 0");
    step(session, 60);
    const CommandLog log = replaced(session.log, "push 3 0 0", "push 3 0 1");
    EXPECT_EQ(verdictOf(Playback(log), playBack(log)),
              Verdict("replay: differs after frame 60 of 130", false));
}

TEST(Playback, SaysWhereAgentsHaveOtherColours) {
    Session session = wanderers(3000);
    session.run("effect response off");  // so that nobody's place depends on whom it meets
    step(session, 60);
    const CommandLog log = replaced(session.log, "radius 5", "radius 50");
    const Session again = playBack(log);
    EXPECT_EQ(again.stage->placesHash(), session.stage->placesHash());
    EXPECT_EQ(verdictOf(Playback(log), again),
              Verdict("replay: differs after frame 0 of 60", false));
}

TEST(Playback, ComesToTheSameHashWhoeverFindsThePairs) {
    std::array<std::uint64_t, 2> hashes{};
    for (const bool isSwapped : {false, true}) {
        Session session = wanderers(2000);
        for (const char* broadphase : {"dbvt", "hash", "simple"}) {
            step(session, 23);  // in the midst of the agents' turns
            session.run(std::string("broadphase ") + (isSwapped ? broadphase : "hash"));
        }
        step(session, 10);
        EXPECT_GT(session.stage->pairCount(), 0U);
        hashes[isSwapped ? 1 : 0] = session.hash();
    }
    EXPECT_EQ(hashes[0], hashes[1]);
}

// --- Settings ------------------------------------------------------------------------------------

TEST(CommandLog, SetsUpWhatASceneFileMayHave) {
    const TemporaryFolder folder;
    const std::string path = folder.file("scene.json");
    for (const char* grid :
         {R"("cellSize": 0, "levelRatio": 2)", R"("cellSize": 1e-30, "levelRatio": 64)",
          R"("cellSize": 1e30, "levelRatio": 2.0000000000000004)",
          R"("cellSize": 0.30000000000000004)"}) {
        for (const char* radius : {"0", "\"none\"", "1e300", "2000", "5.0000000000000009"}) {
            std::ofstream(path) << R"({"scene": {"objects": 30}, "effects": {"motion": true, )"
                                << R"("pairs": true, "proximity": {"radius": )" << radius
                                << R"(}}, "grid": {)" << grid << "}}";
            Session session({.name = {}, .file = path, .objects = {}, .seed = 1});
            step(session, 2);
            Session other({.name = {}, .file = path, .objects = {}, .seed = 1});
            other.run("cell 3");
            other.run("ratio 3");
            other.run("radius 3");
            const CommandLog log = CommandLog::parse(session.log.text(), "recording");
            for (const LoggedCommand& command : log.commands) {
                EXPECT_NO_THROW(other.run(command.line)) << command.line;
            }
            const SceneEffects& declared = session.stage->effects();
            const SceneEffects& again = other.stage->effects();
            EXPECT_EQ(again.grid, declared.grid) << grid;
            EXPECT_EQ(again.proximity->radius, declared.proximity->radius) << radius;
            EXPECT_EQ(playBack(log).hash(), session.hash()) << grid << radius;
        }
    }
}

// Of a session of 130 frames in which bodies are pushed and removed.
CommandLog shortLog() {
    Session session = wanderers(100, 800, 600);
    session.run("pose top 200 7 200 439 0 0 0 0 0 0 0 0 0 20 0 0");
    step(session, 20);
    session.run("box 100 100 700 500");
    session.run("push 1 0 2");
    step(session, 31);
    session.run("delete");
    step(session, 79);
    return session.log;
}

// So many turns of a viewer, or all that it takes.
void turn(Session& session, Playback& playback, int turns = 1'000'000) {
    playback.feed(session);
    for (int i = 0; i < turns && !playback.isDone(session); ++i) {
        session.advance();
        playback.feed(session);
    }
}

TEST(Playback, PausesStepsAndGoesOn) {
    const CommandLog log = shortLog();
    Playback playback(log);
    Session session(log.choice);
    turn(session, playback, 20);
    EXPECT_EQ(session.frame, 20U);
    session.run("pause");
    turn(session, playback, 5);
    EXPECT_EQ(session.frame, 20U);
    session.run("step");
    turn(session, playback, 5);
    EXPECT_EQ(session.frame, 21U);
    session.run("step 40");
    turn(session, playback, 100);
    EXPECT_EQ(session.frame, 61U);
    session.run("pause");
    turn(session, playback);
    EXPECT_EQ(verdictOf(playback, session), kAllTheSame);
}

TEST(Playback, BeginsAgainWithItsFirstCommand) {
    const CommandLog log = shortLog();
    Playback playback(log);
    Session session(log.choice);
    turn(session, playback, 100);
    session.run("restart");
    EXPECT_EQ(session.frame, 0U);
    turn(session, playback);
    EXPECT_EQ(session.hash(), log.hash);
    EXPECT_EQ(session.frame, 130U);
}

TEST(Playback, RefusesWhatWouldMakeItAnotherRecording) {
    for (const char* line : {"turn 10 0", "zoom 2", "pick 3 4", "delete", "objects 5", "seed 3",
                             "scene pile", "effect culling", "broadphase next"}) {
        EXPECT_THROW(Playback::refuseChange(line), InputError) << line;
    }
    for (const char* line :
         {"pause", "step 3", "restart", "overlay heat on", "theme", "help on", "check", "panel",
          "print frame", "screenshot", "save", "capture a 5", "quit", "", "# nothing"}) {
        EXPECT_NO_THROW(Playback::refuseChange(line)) << line;
    }
    EXPECT_EQ(
        messageOf<InputError>([] { Playback::refuseChange("delete"); }),
        "'delete' would change the recording that is replayed. Pause (P), step (O) or restart "
        "(R).");
}

TEST(Playback, SaysHowFarItHasCome) {
    const CommandLog log = shortLog();
    Playback playback(log);
    Session session(log.choice);
    turn(session, playback, 59);
    EXPECT_EQ(verdictOf(playback, session), Verdict("replay: compared 0 of 130 frames", true));
    turn(session, playback, 60);
    EXPECT_EQ(verdictOf(playback, session),
              Verdict("replay: compared 60 of 130 frames, which are the same", true));
}

TEST(Playback, SaysBeforeItsEndWhereItIsNotTheSame) {
    const CommandLog log = shortLog();
    Playback playback(log);
    Session session({.name = "wander", .file = {}, .objects = 100, .seed = 6}, 800, 600);
    turn(session, playback, 70);
    EXPECT_EQ(verdictOf(playback, session), Verdict("replay: differs after frame 0 of 130", false));
}

std::string faultOf(const std::string& text) {
    return messageOf<InputError>([&] { static_cast<void>(CommandLog::parse(text, "file")); });
}

// Of a recording of 60 frames in which one text is replaced by another.
std::string faultWhereReplaced(const std::string& what, const std::string& by) {
    Session session = wanderers(10);
    step(session, 60);
    return faultOf(textWhereReplaced(session.log, what, by));
}

TEST(CommandLog, RefusesWhatNoSessionHasRecorded) {
    struct Case {
        std::string what;
        std::string by;
        std::string fault;
    };
    std::vector<Case> cases{
        {"\"version\": 2", "\"version\": 1",
         "it has version 1, but this program replays only version 2, which also compares agents' "
         "colours: record it again."},
        {"\"objects\": 10", "\"objects\": -5",
         "'objects' must be a whole number from 0 to 1000000, not -5."},
        {"\"seed\": 5", "\"seed\": 1099511627776",
         "'seed' must be a whole number from 0 to 4294967295, not 1099511627776."},
        {"\"hash\": \"0x", "\"hash\": \"0x1\", \"old\": \"0x",
         "its last hash differs from its hash of all frames."},
        {"\"frames\": 60", "\"frames\": 600",
         "its commands are not in the order of their frames, or hashes are missing."}};
    for (const std::string line :  // that write files, or are the onlooker's
         {"save elsewhere.json", "capture elsewhere.aabbs 5", "screenshot elsewhere.png", "quit"}) {
        cases.push_back({"\"command\": \"size 1280 800\"", "\"command\": \"" + line + "\"",
                         "'" + line + "' is not a command of a recording."});
    }
    for (const auto& [what, by, fault] : cases) {
        EXPECT_EQ(faultWhereReplaced(what, by), "file cannot be read as a recording: " + fault);
    }
    EXPECT_EQ(faultOf("{}"), "file cannot be read as a recording: key 'schema' not found.");
    EXPECT_EQ(faultOf("nonsense").substr(0, 72),
              "file cannot be read as a recording: parse error at line 1, column 2: syn");
}

}  // namespace
}  // namespace hashphase::demos
