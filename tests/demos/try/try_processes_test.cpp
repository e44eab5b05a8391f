// SPDX-License-Identifier: Zlib

// What `hashphase try` makes of programs of several processes, and of signals.

#include <tests/demos/try/try_output.hpp>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace hashphase::demos {
namespace {

TEST(Try, LeavesFurtherProcessesTheirBroadphase) {
    const auto [output, json] = measure("", stock("stock-programs") + " starter");
    EXPECT_EQ(output.status, kExitOk) << output.out << output.err;
    EXPECT_TRUE(
        output.out.starts_with("first has trees\nsecond has trees\n"
                               "first has none\nsecond has none\n"))
        << output.out;
    EXPECT_EQ(json["runs"][0]["otherProcesses"], 1);
}

TEST(Try, RecordsTheFirstProcessWithABroadphaseThatCanBeTaken) {
    const auto [output, json] = measure("", stock("stock-programs") + " simple-starter");
    EXPECT_EQ(output.status, kExitOk) << output.out << output.err;
    EXPECT_TRUE(output.out.starts_with("second has trees\nsecond has none\n")) << output.out;
    EXPECT_EQ(json["runs"][1]["steps"].size(), 5U);
}

// The recorded one has ended; who has started it lives on for a minute, and has nothing to do with Bullet.
TEST(Try, DoesNotWaitForTheDead) {
    const Output output =
        runCommand("timeout 50 " + std::string(HASHPHASE_PROGRAM) + " try --quiet -- " +
                   stock("stock-programs") + " leaves-zombie");
    EXPECT_EQ(output.status, kExitOk) << output.out << output.err;
}

// Each run reads the same, and what a script has read before is not read again.
TEST(Try, GivesEachRunTheSameInput) {
    const TemporaryFolder folder;
    const std::string input = folder.write("input", "first\nsecond\n");
    const Output output =
        runCommand("{ read line; " + std::string(HASHPHASE_PROGRAM) + " try --quiet -- " +
                       stock("stock-programs") + " reads-input; } < " + input,
                   folder);
    EXPECT_EQ(countOf(output.out, "read second\n"), 2U) << output.out << output.err;
}

TEST(Try, RecordsWhatTakesThePlaceOfTheRecorded) {
    const auto [output, json] = measure("", stock("stock-programs") + " restarts");
    EXPECT_EQ(json["runs"][0]["steps"].size(), 10U) << output.out << output.err;
    EXPECT_EQ(json["runs"][0]["otherProcesses"], 0);
}

TEST(Try, WaitsForWhatALauncherLeavesBehind) {
    for (const std::string name : {" launcher", " slow-launcher"}) {
        const auto [output, json] = measure("--runs 4", stock("stock-programs") + name);
        EXPECT_EQ(output.status, kExitOk) << output.out << output.err;
        ASSERT_EQ(json["runs"].size(), 8U) << name;
        for (const Json& run : json["runs"]) {
            EXPECT_EQ(run["steps"].size(), 5U) << name;
        }
    }
}

TEST(Try, TakesTheEndOfWhatALauncherLeavesBehind) {
    const auto [output, json] = measure("", stock("stock-programs") + " crash-launcher");
    EXPECT_EQ(output.status, kExitCheckFailed) << output.out << output.err;
    EXPECT_TRUE(has(output.out,
                    "ended with status 0 with Bullet's broadphase, and was ended by "
                    "signal 6 (Aborted) with hashphase"))
        << output.out;
}

TEST(Try, CountsForksThatStepTheWorldOfTheRecorded) {
    const auto [output, json] = measure("", stock("stock-programs") + " forks-with-a-world");
    EXPECT_EQ(json["runs"][0]["steps"].size(), 5U);
    EXPECT_EQ(json["runs"][0]["otherProcesses"], 1);
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
TEST(Try, EndsAllThatTheProgramHasStarted) {
    const TemporaryFolder folder;
    const std::string program = linkToStockPrograms(folder);
    const std::string call = "\"" + program + "\" endless";
    const auto [output, json] =
        measure("--steps 20 --precision single", "/bin/sh -c '" + call + " & " + call + " & wait'");
    EXPECT_EQ(output.status, kExitOk) << output.out << output.err;
    EXPECT_GE(countOf(output.out, "has begun\n"), 2U);
    EXPECT_FALSE(hasProcessOf(program));
}

TEST(Try, WaitsForAnOrphanUnderAnotherName) {
    const auto [output, json] = measure("", stock("stock-programs") + " renamed-orphan");
    EXPECT_EQ(countOf(output.out, "the orphan has ended\n"), 2U) << output.out << output.err;
    for (const Json& run : json["runs"]) {
        EXPECT_EQ(run["steps"].size(), 100U);
        EXPECT_EQ(run["ended"], "ended with status 9");
    }
}

// A shell that ends with status 0, whatever its program does.
TEST(Try, SeesACrashThatItsStarterKeepsToItself) {
    const auto starting = [](const std::string& name) {
        return "/bin/sh -c '" + stock("stock-programs") + " " + name + "; true'";
    };
    const auto [output, json] = measure("--precision single", starting("crashes-without-trees"));
    EXPECT_EQ(output.status, kExitCheckFailed);
    EXPECT_TRUE(has(output.out,
                    "ended with status 0 with Bullet's broadphase, and was ended otherwise than by "
                    "exit(), after which what had started it ended with status 0 with hashphase."))
        << output.out;
    const Output verified =
        tryProgram("--quiet --verify --precision single -- " + starting("crashing"));
    EXPECT_EQ(verified.status, kExitCheckFailed);
    EXPECT_TRUE(has(verified.out, "The program was ended otherwise than by exit()"))
        << verified.out;
    for (const std::string name : {"exit-anyhow", "failing", "quick-exit", "exit-at-once"}) {
        const Output regular =
            tryProgram("--quiet --verify --precision single -- " + starting(name));
        EXPECT_EQ(regular.status, kExitOk) << name << regular.out;
    }
}

TEST(Try, LetsAScriptCleanUpBehindItsProgram) {
    const TemporaryFolder folder;
    const auto [output, json] =
        measure("--steps 20 --precision single", "/bin/sh -c 'trap \"echo cleaned up\" EXIT; " +
                                                     stock("stock-programs") + " endless'");
    EXPECT_EQ(output.status, kExitOk) << output.out << output.err;
    EXPECT_EQ(countOf(output.out, "cleaned up\n"), 2U) << output.out;
}

// The second time there is no line left to read.
TEST(Try, KeepsWhatWasMeasuredBeforeARunWithoutABroadphase) {
    const TemporaryFolder folder;
    const Output output =
        runCommand("printf 'a\\nb\\n' | " + std::string(HASHPHASE_PROGRAM) + " try --quiet -- " +
                       stock("stock-programs") + " waits-for-input",
                   folder);
    EXPECT_EQ(output.status, kExitCheckFailed) << output.out << output.err;
    EXPECT_TRUE(has(output.out,
                    "Run 2 has made no broadphase, and ended with status 1: it was "
                    "the last."))
        << output.out;
}

// Where the program has a number of its own for itself, which is that of another process here.
TEST(Try, EndsTheProgramThatIsRecordedAndNoOtherOfItsNumber) {
    const std::string unshare = "unshare --fork --pid ";
    if (runCommand(unshare + "true").status != 0) {
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

/// Runs `script` in a shell, in the folder, in which $try is the program with the word `try`. The program that
/// is tried says when it has made its first step; its output goes to the file `out`.
Output runScript(const std::string& script, const TemporaryFolder& folder) {
    const std::string begin =
        "cd '" + folder.path().string() + "'\ntry=\"" + HASHPHASE_PROGRAM +
        " try\"\nstock=" + stock("stock-programs") + "\n" +
        "until_it_has_begun() {\n"
        "  until grep -q 'has begun' out || ! kill -0 $!; do sleep 0.01; done\n}\n";
    return runCommand("sh '" + folder.write("script", begin + script) + "'", folder);
}

TEST(Try, EndsWithItsProgramWhenItIsEnded) {
    const TemporaryFolder folder;
    const Output output = runScript(
        "TMPDIR=. $try --quiet -- $stock endless >out & until_it_has_begun\n"
        "kill $!; wait $!; echo status $?; ls\n",
        folder);
    EXPECT_TRUE(has(output.out, "status 143\n")) << output.out;
    EXPECT_FALSE(has(output.out, "hashphase-try-")) << output.out;
}

TEST(Try, PassesAnInterruptOnThatIsNotTheKeyboards) {
    const TemporaryFolder folder;
    const Output output = runScript(
        "env --default-signal=INT $try --quiet -- $stock interruptible >out & "
        "until_it_has_begun\n"
        "kill -INT $!; wait $!; echo status $?; cat out\n",
        folder);
    EXPECT_TRUE(has(output.out, "interrupted\n")) << output.out << output.err;
    EXPECT_TRUE(has(output.out, "status 130\n")) << output.out << output.err;
}

// The first run reads the line, and the second waits for another.
TEST(Try, SaysWhatWasMeasuredBeforeARunThatIsInterruptedAsItStarts) {
    const TemporaryFolder folder;
    const Output output = runScript(
        "mkfifo input; exec 3<>input; echo go >&3; echo on >&3\n"
        "$try --json json -- $stock waits-for-input <&3 2>progress &\n"
        "until grep -q 'run 2 of 2' progress; do sleep 0.05; done\n"
        "kill $!; wait $!; echo status $?; cat json\n",
        folder);
    EXPECT_TRUE(has(output.out, "status 143\n")) << output.out << output.err;
    EXPECT_EQ(countOf(output.out, "\"broadphase\": \"bullet\""), 1U) << output.out;
    EXPECT_EQ(countOf(output.out, "\"broadphase\": \"hashphase\""), 0U) << output.out;
}

TEST(Try, SaysWhatWasMeasuredInTheFirstRunAlone) {
    const TemporaryFolder folder;
    const Output output = runScript(
        "$try --quiet -- $stock endless >out & until_it_has_begun\n"
        "kill $!; wait $!; echo status $?; cat out\n",
        folder);
    EXPECT_TRUE(has(output.out, "There was no run with hashphase. With Bullet's broadphase, "))
        << output.out << output.err;
    EXPECT_TRUE(has(output.out, "status 143\n")) << output.out << output.err;
}

TEST(Try, LeavesSignalsIgnoredThatAre) {
    const TemporaryFolder folder;
    const Output output = runScript(
        "env --ignore-signal=HUP $try --quiet --seconds 0.5 -- $stock endless >out & "
        "until_it_has_begun\n"
        "kill -HUP $!; wait $!; echo status $?\n",
        folder);
    EXPECT_TRUE(has(output.out, "status 0\n")) << output.out << output.err;
}

TEST(Try, WaitsWhereWhoStartedItIgnoresTheEndOfItsChildren) {
    const TemporaryFolder folder;
    const Output output = runScript(
        "env --ignore-signal=CHLD $try --quiet -- $stock failing\n"
        "HASHPHASE_TRY_RECORD=/no/such/file $try --quiet -- $stock failing\n",
        folder);
    EXPECT_EQ(countOf(output.out, "With hashphase a step takes "), 2U) << output.out << output.err;
}

}  // namespace
}  // namespace hashphase::demos
