// SPDX-License-Identifier: Zlib
//
// Plays the scripts in the folder scripts/. Their comments that begin with "#!" are for this test:
//
//   #! session SCENE N    what it is played in, in the first line
//   #! says TEXT          the next command says that, and others nothing
//   #! fails TEXT         the next command cannot be run, for that reason; or one that begins so, before "..."
//   #! begins             the steps that the next command asks for are not waited for
//   #! advance            a frame of the viewer
//   #! declares EFFECT    is so now; or lacks EFFECT, or broadphase NAME

#include <demos/scenes/file_bytes.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/viewer/session/commands.hpp>
#include <tests/viewer/session/steps.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
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
        names.push_back(file.path().stem().string());
    }
    std::ranges::sort(names);
    return names;
}

std::string textOf(const std::string& name) {
    return readFile(HASHPHASE_VIEWER_SCRIPTS "/" + name + ".script");
}

/// What a script is played by.
class Player {
public:
    void play(const std::string& line) {
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

    [[nodiscard]] const Session& session() const { return *session_; }

private:
    void obey(const std::string& what, const std::string& text) {
        if (what == "session") {
            std::istringstream words(text);
            SceneChoice choice;
            std::size_t objects = 0;
            words >> choice.name >> objects;
            choice.objects = objects;
            session_ = std::make_unique<Session>(choice, 800, 600);
            session_->isPlaying = false;
        } else if (what == "says") {
            said_ = {text};
        } else if (what == "fails") {
            fault_ = text;
        } else if (what == "begins") {
            waits_ = false;
        } else if (what == "advance") {
            session_->advance();
        } else if (what == "broadphase") {
            EXPECT_EQ(session_->stage->broadphase().name, text);
        } else {
            ASSERT_TRUE(what == "declares" || what == "lacks") << what;
            const auto effect = std::ranges::find(kAllEffects, text, nameOf);
            EXPECT_EQ(session_->stage->effects().set().contains(*effect), what == "declares");
        }
    }

    void run(const std::string& line) {
        const std::size_t logged = session_->log.commands.size();
        const std::string fault = faultOf(*session_, line);
        const std::string wanted = std::exchange(fault_, "none");
        if (wanted.ends_with("...")) {
            EXPECT_EQ(fault.substr(0, wanted.size() - 3) + "...", wanted);
        } else {
            EXPECT_EQ(fault, wanted);
        }
        EXPECT_TRUE(fault == "none" || session_->log.commands.size() == logged) << "is recorded";
        while (waits_ && session_->isWaiting()) {
            session_->advance();
        }
        waits_ = true;
        static const std::set<std::string> kTell{"print", "push", "delete", "recolour"};
        const std::vector<std::string> said = session_->takeMessages();
        if (!kTell.contains(firstWord(line))) {
            EXPECT_EQ(said, std::exchange(said_, {}));
        }
    }

    std::unique_ptr<Session> session_;
    std::string fault_ = "none";
    std::vector<std::string> said_;
    bool waits_ = true;
};

class ViewerScript : public testing::TestWithParam<std::string> {};

TEST_P(ViewerScript, HoldsWhatItExpects) {
    Player player;
    std::istringstream lines(textOf(GetParam()));
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
        SCOPED_TRACE(GetParam() + ".script:" + std::to_string(++number) + ": " + line);
        player.play(line);
    }
    EXPECT_EQ(player.session().failureCount, 0);
}

INSTANTIATE_TEST_SUITE_P(Scripts, ViewerScript, testing::ValuesIn(namesOfScripts()),
                         [](const auto& script) { return script.param; });

TEST(ViewerScripts, HaveEachCommandThatWritesNoFile) {
    std::set<std::string> used;
    std::istringstream lines(textOf("features"));
    for (std::string line; std::getline(lines, line);) {
        used.emplace(firstWord(line));
    }
    for (const CommandKind& kind : commandKinds()) {
        EXPECT_TRUE(kind.role == CommandRole::writes || used.contains(kind.name)) << kind.name;
    }
}

}  // namespace
}  // namespace hashphase::demos
