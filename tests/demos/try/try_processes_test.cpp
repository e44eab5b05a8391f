// SPDX-License-Identifier: Zlib

// What `hashphase try` makes of programs of several processes, and of signals.

#include <tests/demos/try/try_output.hpp>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace hashphase::demos {
namespace {

// The recorded one has ended; who has started it lives on for a minute, and has nothing to do with Bullet.
TEST(TryProcesses, DoesNotWaitForTheDead) {
    const Output output =
        runCommand("timeout 50 " + kTry + "--quiet -- " + kStock + "leaves-zombie");
    EXPECT_EQ(output.status, kExitOk) << output.out << output.err;
}

// Each run reads the same, and what a script has read before is not read again.
TEST(TryProcesses, GivesEachRunTheSameInput) {
    const TemporaryFolder folder;
    const std::string input = folder.write("input", "first\nsecond\n");
    const Output output = runCommand(
        "{ read line; " + kTry + "--quiet -- " + kStock + "reads-input; } < " + input, folder);
    EXPECT_EQ(countOf(output.out, "read second\n"), 2U) << output.out << output.err;
}

/// A name of its own for the stock programs, by which their processes can be told from others'.
std::string linkToStockPrograms(const TemporaryFolder& folder) {
    std::string link = folder.file("stock-programs");
    std::filesystem::create_symlink(stock("stock-programs"), link);
    return link;
}

bool hasProcessOf(const std::string& program) {
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
        std::ifstream file(entry.path() / "cmdline");
        std::string first;
        if (std::getline(file, first, '\0') && first == program) {
            return true;
        }
    }
    return false;
}

// One of which is recorded.
TEST(TryProcesses, EndsAllThatTheProgramHasStarted) {
    const TemporaryFolder folder;
    const std::string program = linkToStockPrograms(folder);
    const std::string call = "\"" + program + "\" endless";
    const auto [output, json] =
        measure("--steps 20 --precision single", "/bin/sh -c '" + call + " & " + call + " & wait'");
    EXPECT_EQ(output.status, kExitOk) << output.out << output.err;
    EXPECT_GE(countOf(output.out, "has begun\n"), 2U);
    EXPECT_FALSE(hasProcessOf(program));
}

// The second time there is no line left to read.
TEST(TryProcesses, KeepsWhatWasMeasuredBeforeARunWithoutABroadphase) {
    const Output output =
        runCommand("printf 'a\\nb\\n' | " + kTry + "--quiet -- " + kStock + "waits-for-input");
    EXPECT_EQ(output.status, kExitCheckFailed) << output.out << output.err;
    EXPECT_TRUE(
        has(output.out, "Run 2 has made no broadphase, and ended with status 1: it was the last."))
        << output.out;
}

// Where the program has a number of its own for itself, which is that of another process here.
TEST(TryProcesses, EndsTheProgramThatIsRecordedAndNoOtherOfItsNumber) {
    if (runCommand("unshare --fork --pid true").status != 0) {
        GTEST_SKIP() << "no namespace of processes can be made";
    }
    const TemporaryFolder folder;
    const std::string program = linkToStockPrograms(folder);
    const auto [output, json] =
        measure("--precision single --steps 20",
                "$(which unshare) --fork --pid sh -c '\"" + program + "\" endless; true'");
    EXPECT_EQ(output.status, kExitOk) << output.out << output.err;
    ASSERT_EQ(json["runs"].size(), 2U);
    EXPECT_EQ(json["runs"][1]["steps"].size(), 20U);
    EXPECT_FALSE(hasProcessOf(program));
}

// --- Signals -------------------------------------------------------------------------------------

/// What a shell does, in which $try is the program with the word `try` and $stock the one that is tried, which
/// says when it has made its first step; its output goes to the file `out`.
struct Script {
    std::string name;
    std::string text;
    std::vector<std::string> words;      // that it writes
    std::vector<std::string> noWords{};  // that it does not
};

class TryScript : public testing::TestWithParam<Script> {};

TEST_P(TryScript, Writes) {
    const TemporaryFolder folder;
    const std::string begin =
        "cd '" + folder.path().string() + "'\ntry=\"" + kTry + "\"\nstock=" + kStock +
        "\nuntil_it_has_begun() {\n"
        "  until grep -q 'has begun' out || ! kill -0 $!; do sleep 0.01; done\n}\n";
    const Output output =
        runCommand("sh '" + folder.write("script", begin + GetParam().text) + "'", folder);
    for (const std::string& word : GetParam().words) {
        EXPECT_TRUE(has(output.out, word)) << word << " in " << output.out << output.err;
    }
    for (const std::string& word : GetParam().noWords) {
        EXPECT_FALSE(has(output.out, word)) << word << " in " << output.out;
    }
}

const std::vector<Script> kScripts{
    {"EndsWithItsProgramWhenItIsEnded",
     "TMPDIR=. $try --quiet -- $stock endless >out & until_it_has_begun\n"
     "kill $!; wait $!; echo status $?; ls\n",
     {"status 143\n"},
     {"hashphase-try-"}},
    {"PassesAnInterruptOnThatIsNotTheKeyboards",
     "env --default-signal=INT $try --quiet -- $stock interruptible >out & until_it_has_begun\n"
     "kill -INT $!; wait $!; echo status $?; cat out\n",
     {"interrupted\n", "status 130\n"}},
    // The first run reads the line, and the second waits for another.
    {"SaysWhatWasMeasuredBeforeARunThatIsInterruptedAsItStarts",
     "mkfifo input; exec 3<>input; echo go >&3; echo on >&3\n"
     "$try --json json -- $stock waits-for-input <&3 2>progress &\n"
     "until grep -q 'run 2 of 2' progress; do sleep 0.05; done\n"
     "kill $!; wait $!; echo status $?; grep -c '\"broadphase\": \"bullet\"' json; cat json\n",
     {"status 143\n1\n"},
     {"\"broadphase\": \"hashphase\""}},
    {"SaysWhatWasMeasuredInTheFirstRunAlone",
     "$try --quiet -- $stock endless >out & until_it_has_begun\n"
     "kill $!; wait $!; echo status $?; cat out\n",
     {"There was no run with hashphase. With Bullet's broadphase, ", "status 143\n"}},
    {"LeavesSignalsIgnoredThatAre",
     "env --ignore-signal=HUP $try --quiet --seconds 0.5 -- $stock endless >out & "
     "until_it_has_begun\n"
     "kill -HUP $!; wait $!; echo status $?\n",
     {"status 0\n"}},
    {"WaitsWhereWhoStartedItIgnoresTheEndOfItsChildren",
     "env --ignore-signal=CHLD $try --quiet -- $stock failing >out\n"
     "HASHPHASE_TRY_RECORD=/no/such/file $try --quiet -- $stock failing >>out\n"
     "grep -c 'With hashphase a step takes ' out\n",
     {"2\n"}},
};

INSTANTIATE_TEST_SUITE_P(Signals, TryScript, testing::ValuesIn(kScripts),
                         [](const auto& each) { return each.param.name; });

}  // namespace
}  // namespace hashphase::demos
