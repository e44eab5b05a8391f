// SPDX-License-Identifier: Zlib
//
// Plays the scripts in the folder scripts/; FOLDER in their lines is an empty one. What was done in a session since
// its scene began is played back at its end, and comes to the same. Comments that begin with "#!" are for this test:
//
//   #! session SCENE N [S]  in the first line: what follows is played in a new one, of seed S; SCENE may be a file
//   #! says TEXT            the next command says that, or #! rest does, and others nothing
//   #! fails TEXT           the next command cannot be run, for that reason; or one that begins so, before "..."
//   #! begins               the steps that the next command asks for are not waited for
//   #! advance              a frame of the viewer
//   #! rest                 all steps that are waited for
//   #! failed               an expectation did not hold, or a capture has failed, since the last time
//   #! declares EFFECT      is so now; or lacks EFFECT, or broadphase NAME
//   #! picks                a body, from nearby
//   #! removes INDEX        a body, as no command does
//   #! write NAME           a file in FOLDER, of the session before
//   #! kept NAME            it is as it was written, and there is no other
//   #! part NAME            the lines of the file NAME.part

#include <demos/console/format.hpp>
#include <demos/scenes/file_bytes.hpp>
#include <demos/viewer/session/commands.hpp>
#include <demos/viewer/session/script.hpp>
#include <tests/support/temporary_folder.hpp>
#include <tests/viewer/session/stages.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace hashphase::demos {
namespace {

std::vector<std::string> namesOfScripts() {
    std::vector<std::string> names;
    for (const auto& file : std::filesystem::directory_iterator(HASHPHASE_VIEWER_SCRIPTS)) {
        if (file.path().extension() == ".script") {
            names.push_back(file.path().stem().string());
        }
    }
    std::ranges::sort(names);
    return names;
}

std::string textOf(const std::string& file) {
    return readFile(HASHPHASE_VIEWER_SCRIPTS "/" + file);
}

/// All that a playback gives back, besides its verdict.
void expectTheSame(const Session& again, const Session& session) {
    EXPECT_EQ(again.hash(), session.hash());
    EXPECT_EQ(again.stage->size(), session.stage->size());
    EXPECT_EQ(again.selected, session.selected);
    EXPECT_EQ(again.picked, session.picked);
    EXPECT_EQ(again.recoloured, session.recoloured);
    EXPECT_EQ(again.camera.mode(), session.camera.mode());
    EXPECT_EQ(again.camera.state(), session.camera.state());
    EXPECT_EQ(again.options.colouring, session.options.colouring);
    EXPECT_EQ(again.options.overlays, session.options.overlays);
    EXPECT_EQ(again.options.dots, session.options.dots);
    EXPECT_EQ(again.options.theme, session.options.theme);
    EXPECT_EQ(again.isChecking, session.isChecking);
    EXPECT_EQ(again.width, session.width);
    EXPECT_EQ(again.stage->broadphase().name, session.stage->broadphase().name);
    EXPECT_EQ(again.stage->effects().set(), session.stage->effects().set());
    EXPECT_EQ(again.stage->effects().grid, session.stage->effects().grid);
    if (session.stage->effects().proximity) {
        EXPECT_TRUE(std::ranges::equal(again.stage->observers().colours(),
                                       session.stage->observers().colours()));
    }
}

/// What a script is played by.
class Player {
public:
    explicit Player(std::string script) : script_(std::move(script)) {}

    void play(const std::string& file) {
        std::istringstream lines(textOf(file));
        int number = 0;
        for (std::string line; std::getline(lines, line);) {
            SCOPED_TRACE(script_ + ", " + file + ":" + std::to_string(++number) + ": " + line);
            for (std::size_t at = 0; (at = line.find("FOLDER", at)) != std::string::npos;) {
                line.replace(at, 6, folder_.path().string());
            }
            std::istringstream words(line);
            std::string begin;
            std::string what;
            words >> begin >> what;
            std::string text;
            std::getline(words >> std::ws, text);
            if (begin == "#!") {
                obey(what, text);
            } else {
                run(line);
            }
        }
    }

    /// Plays back what was done, unless it was something that no command does.
    void end() {
        if (session_ == nullptr) {
            return;
        }
        EXPECT_EQ(session_->failureCount, 0);
        EXPECT_EQ(session_->takeMessages(), std::exchange(said_, {}));
        EXPECT_EQ(fault_, "none");
        if (!canReplay_) {
            return;
        }
        Playback playback(CommandLog::parse(session_->log.text(), "recording"));
        Session again(playback.log().choice);
        for (playback.feed(again); !playback.isDone(again); playback.feed(again)) {
            again.advance();
        }
        expectTheSame(again, *session_);
        bool isSame = false;
        EXPECT_EQ(playback.verdict(again, isSame), "replay: all " + withThousands(session_->frame) +
                                                       " frames are the same, to the last bit");
    }

private:
    void obey(const std::string& what, const std::string& text) {
        if (what == "session") {
            begin(text);
        } else if (what == "says") {
            said_ = {text};
        } else if (what == "fails") {
            fault_ = text;
        } else if (what == "begins") {
            waits_ = false;
        } else if (what == "advance") {
            session_->advance();
        } else if (what == "rest") {
            expectSaid();
        } else if (what == "failed") {
            EXPECT_EQ(std::exchange(session_->failureCount, 0), 1);
        } else if (what == "broadphase") {
            EXPECT_EQ(session_->stage->broadphase().name, text);
        } else if (what == "picks") {
            pickSomebody();
        } else if (what == "removes") {
            const auto index = static_cast<std::uint32_t>(std::stoul(text));
            EXPECT_EQ(session_->stage->remove(std::array{index}), 1U);
            canReplay_ = false;
        } else if (what == "write") {
            folder_.write(text, "of before");
        } else if (what == "kept") {
            EXPECT_EQ(readFile(folder_.file(text)), "of before");
            using Iterator = std::filesystem::directory_iterator;
            EXPECT_EQ(std::distance(Iterator(folder_.path()), Iterator()), 1);
        } else if (what == "part") {
            play(text + ".part");
        } else {
            ASSERT_TRUE(what == "declares" || what == "lacks") << what;
            const auto effect = std::ranges::find(kAllEffects, text, nameOf);
            EXPECT_EQ(session_->stage->effects().set().contains(*effect), what == "declares");
        }
    }

    void begin(const std::string& text) {
        end();
        std::istringstream words(text);
        SceneChoice choice;
        words >> choice.name;
        if (std::size_t objects = 0; words >> objects) {
            choice.objects = objects;
        }
        if (std::uint64_t seed = 0; words >> seed) {
            choice.seed = seed;
        }
        if (choice.name.find('/') != std::string::npos) {
            choice.file = std::exchange(choice.name, {});
        }
        canReplay_ = true;
        session_.reset();
        session_ = std::make_unique<Session>(choice, 800, 600);
        session_->isPlaying = false;
    }

    /// What was said since the last time, when no more steps are waited for.
    void expectSaid() {
        while (session_->isWaiting()) {
            session_->advance();
        }
        EXPECT_EQ(session_->takeMessages(), std::exchange(said_, {}));
    }

    void run(const std::string& line) {
        ASSERT_TRUE(session_) << "a script begins with #! session";
        const std::size_t logged = session_->log.commands.size();
        const std::string fault = faultOf(*session_, line);
        const std::string wanted = std::exchange(fault_, "none");
        if (wanted.ends_with("...")) {
            EXPECT_EQ(fault.substr(0, wanted.size() - 3) + "...", wanted);
        } else {
            EXPECT_EQ(fault, wanted);
        }
        EXPECT_TRUE(fault == "none" || session_->log.commands.size() == logged) << "is recorded";
        static const std::set<std::string> kTell{"print", "push", "delete", "recolour"};
        if (kTell.contains(firstWord(line))) {
            static_cast<void>(session_->takeMessages());
        }
        if (std::exchange(waits_, true)) {
            expectSaid();
        }
    }

    /// From so near that no ground is between, where bodies have fallen through it without pairs.
    void pickSomebody() {
        std::uint32_t index = 0;
        while (!session_->stage->contains(index)) {
            ++index;
        }
        const Vector3<float> at = session_->stage->body(index).centre;
        std::ostringstream line;
        line << "eye " << at.x() << ' ' << at.y() + 2 << ' ' << at.z() << " 0 -90";
        run(line.str());
        run("pick " + std::to_string(session_->width / 2) + " " +
            std::to_string(session_->height / 2));
        EXPECT_TRUE(session_->card);
    }

    std::string script_;
    TemporaryFolder folder_;
    std::unique_ptr<Session> session_;
    std::string fault_ = "none";
    std::vector<std::string> said_;
    bool waits_ = true;
    bool canReplay_ = true;
};

class ViewerScript : public testing::TestWithParam<std::string> {};

TEST_P(ViewerScript, HoldsWhatItExpectsAndIsTheSamePlayedBack) {
    Player player(GetParam());
    player.play(GetParam() + ".script");
    player.end();
}

INSTANTIATE_TEST_SUITE_P(Scripts, ViewerScript, testing::ValuesIn(namesOfScripts()),
                         [](const auto& script) { return script.param; });

TEST(ViewerScripts, HaveEachCommandThatWritesNoFile) {
    std::set<std::string> used;
    std::istringstream lines(textOf("features.script"));
    for (std::string line; std::getline(lines, line);) {
        used.emplace(firstWord(line));
    }
    for (const CommandKind& kind : commandKinds()) {
        EXPECT_TRUE(kind.role == CommandRole::writes || used.contains(kind.name)) << kind.name;
    }
}

}  // namespace
}  // namespace hashphase::demos
