// SPDX-License-Identifier: Zlib

#include <demos/scenes/file_bytes.hpp>
#include <demos/scenes/recording_scene.hpp>
#include <demos/viewer/session/session.hpp>
#include <tests/support/temporary_folder.hpp>
#include <tests/viewer/session/steps.hpp>

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace hashphase::demos {
namespace {

class Capture : public testing::Test {
protected:
    Capture() { folder_.write("boxes.aabbs", "of before"); }

    [[nodiscard]] std::string path() const { return folder_.file("boxes.aabbs"); }

    /// The file is as it was, and there is no other.
    void expectUntouched() const {
        EXPECT_TRUE(readFile(path()) == "of before");
        using Iterator = std::filesystem::directory_iterator;
        EXPECT_EQ(std::distance(Iterator(folder_.path()), Iterator()), 1);
    }

    /// What is said until no step is waited for.
    static std::string saidUntilEnd(Session& session) {
        std::string all;
        do {
            session.advance();
            for (const std::string& message : session.takeMessages()) {
                all += message + '\n';
            }
        } while (session.isWaiting());
        return all;
    }

    Session session_{{.name = "wander", .file = {}, .objects = 100, .seed = 3}, 800, 600};

private:
    TemporaryFolder folder_;
};

TEST_F(Capture, TakesFramesAsTheyAreSimulated) {
    session_.run("capture " + path() + " 20");
    EXPECT_EQ(session_.frame, 0U);
    session_.advance();
    EXPECT_EQ(session_.frame, 1U);
    EXPECT_TRUE(readFile(path()) == "of before");
    EXPECT_EQ(saidUntilEnd(session_), "wrote the boxes of 20 frames to " + path() + "\n");
    EXPECT_EQ(session_.frame, 20U);
    RecordingScene recording(path(), 0);
    EXPECT_EQ(recording.frameLimit(), 21);
    EXPECT_EQ(recording.boxes().size(), 100U);
}

TEST_F(Capture, IsDoneBeforeTheNextLineOfAScript) {
    const auto said = runScript(session_, "capture " + path() + " 7\nexpect frame = 7\n");
    EXPECT_EQ(said, std::vector<std::string>{"wrote the boxes of 7 frames to " + path()});
    EXPECT_EQ(session_.failureCount, 0);
}

TEST_F(Capture, LeavesAloneWhetherTheSceneIsPlayed) {
    for (const bool isPlaying : {true, false}) {
        session_.isPlaying = isPlaying;
        session_.run("capture " + path() + " 3");
        saidUntilEnd(session_);
        EXPECT_EQ(session_.isPlaying, isPlaying);
        EXPECT_FALSE(session_.recorder);
    }
}

TEST_F(Capture, LeavesTheFileAsItWasAndNamesTheBodyThatFliesTooFar) {
    Session session({.name = "pile", .file = {}, .objects = 50, .seed = 1}, 1280, 800);
    step(session, 30);
    session.run("box 0 0 1280 800");
    for (int i = 0; i < 3; ++i) {
        session.run("push 1000000 0 0");
    }
    session.run("clear");
    static_cast<void>(session.takeMessages());
    session.run("capture " + path() + " 120");
    const std::string said = saidUntilEnd(session);
    EXPECT_NE(said.find(path() + " is not written: body "), std::string::npos) << said;
    EXPECT_NE(said.find("is farther than 1,000,000 m from the origin after "), std::string::npos)
        << said;
    EXPECT_EQ(session.failureCount, 1);
    EXPECT_LT(session.frame, 150U);
    expectUntouched();
}

TEST_F(Capture, SaysHowManyAreTooFarToBeRecorded) {
    Session session({.name = "pile", .file = {}, .objects = 50, .seed = 1}, 1280, 800);
    step(session, 1);
    session.run("box 0 0 1280 800");
    const std::size_t all = session.selected.size();
    session.run("box 0 0 640 800");
    const std::size_t far = session.selected.size();
    ASSERT_GT(far, 1U);
    ASSERT_LT(far, all);
    session.run("push 1000000 0 0");
    session.run("push 1000000 0 0");
    step(session, 120);
    static_cast<void>(session.takeMessages());
    session.run("capture " + path() + " 2");
    EXPECT_EQ(saidUntilEnd(session),
              "wrote the boxes of 2 frames to " + path() + ", without " + std::to_string(far) +
                  " bodies that are farther than 1,000,000 m from the origin\n");
    EXPECT_EQ(session.failureCount, 0);
}

TEST_F(Capture, IsRefusedWhereThereIsNobody) {
    session_.run("box 0 0 800 600");
    session_.run("delete");
    ASSERT_EQ(session_.stage->size(), 0U);
    EXPECT_EQ(faultOf(session_, "capture " + path() + " 5"),
              path() + " is not written: there are no bodies.");
    EXPECT_FALSE(session_.recorder);
    expectUntouched();
}

TEST_F(Capture, GoesOnAfterAPause) {
    session_.run("capture " + path() + " 5");
    session_.advance();
    session_.run("pause");
    session_.advance();
    EXPECT_EQ(session_.frame, 1U);
    EXPECT_TRUE(session_.recorder);
    session_.run("step 4");
    EXPECT_EQ(saidUntilEnd(session_), "wrote the boxes of 5 frames to " + path() + "\n");
}

TEST_F(Capture, LeavesTheFileAsItWasWhereABodyIsRemoved) {
    session_.run("capture " + path() + " 10");
    session_.advance();
    EXPECT_EQ(session_.stage->remove(std::array{42U}), 1U);
    EXPECT_EQ(saidUntilEnd(session_),
              path() + " is not written: body 42 is gone after 1 of 10 frames.\n");
    EXPECT_EQ(session_.failureCount, 1);
    expectUntouched();
}

TEST_F(Capture, LeavesTheFileAsItWasWhereTheSceneBeginsAgain) {
    session_.run("capture " + path() + " 10");
    session_.advance();
    session_.run("restart");
    EXPECT_EQ(
        session_.takeMessages(),
        std::vector<std::string>{path() + " is not written: the scene ends after 1 of 10 frames."});
    EXPECT_EQ(session_.failureCount, 1);
    expectUntouched();
}

TEST_F(Capture, LeavesTheFileAsItWasWhereTheSessionEnds) {
    {
        Session session({.name = "wander", .file = {}, .objects = 100, .seed = 3}, 800, 600);
        session.run("capture " + path() + " 10");
        session.advance();
    }
    expectUntouched();
}

TEST_F(Capture, RefusesWhatCannotBeWrittenBeforeItSimulatesAnything) {
    EXPECT_EQ(faultOf(session_, "capture /nowhere/a.aabbs 5"),
              "/nowhere/a.aabbs cannot be written.");
    EXPECT_EQ(faultOf(session_, "capture /tmp 5"), "/tmp cannot be written.");
    EXPECT_FALSE(session_.isWaiting());
    session_.run("capture " + path() + " 5");
    EXPECT_EQ(faultOf(session_, "capture " + path() + "2 5"),
              "Boxes are captured to " + path() + " already: 0 of 5 frames are there.");
}

}  // namespace
}  // namespace hashphase::demos
