// SPDX-License-Identifier: Zlib

// What `hashphase try` makes of programs of several processes, and of signals.

#include <tests/demos/try/try_output.hpp>

#include <gtest/gtest.h>

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

// One of which is recorded.
TEST(Try, EndsAllThatTheProgramHasStarted) {
    const std::string program = stock("stock-programs") + " endless";
    const auto [output, json] = measure("--steps 20 --precision single",
                                        "/bin/sh -c '" + program + " & " + program + " & wait'");
    EXPECT_EQ(output.status, kExitOk) << output.out << output.err;
    EXPECT_EQ(runCommand("pgrep -f '^" + program + "'").out, "");
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
    const auto [output, json] =
        measure("--precision single --steps 20", "$(which unshare) --fork --pid sh -c '" +
                                                     stock("stock-programs") + " endless; true'");
    EXPECT_EQ(output.status, kExitOk) << output.out << output.err;
    ASSERT_EQ(json["runs"].size(), 2U);
    EXPECT_EQ(json["runs"][1]["steps"].size(), 20U);
    EXPECT_EQ(runCommand("pgrep -f '^" + stock("stock-programs") + " endless'").out, "");
}

// --- Signals -------------------------------------------------------------------------------------

/// Runs `script` in a shell, in which $try is the program with the word `try`.
Output runScript(const std::string& script, const TemporaryFolder& folder) {
    const std::string begin = "folder=" + folder.path().string() + "\ntry=\"" + HASHPHASE_PROGRAM +
                              " try\"\nstock=" + stock("stock-programs") + "\n";
    return runCommand("sh " + folder.write("script", begin + script), folder);
}

TEST(Try, EndsWithItsProgramWhenItIsEnded) {
    const TemporaryFolder folder;
    const Output output = runScript(
        "TMPDIR=$folder $try --quiet -- $stock endless & sleep 0.5\n"
        "kill $!; wait $!; echo status $?; ls $folder\n",
        folder);
    EXPECT_TRUE(has(output.out, "status 143\n")) << output.out;
    EXPECT_FALSE(has(output.out, "hashphase-try-")) << output.out;
}

TEST(Try, PassesAnInterruptOnThatIsNotTheKeyboards) {
    const TemporaryFolder folder;
    const Output output = runScript(
        "env --default-signal=INT $try --quiet -- $stock interruptible & sleep 0.5\n"
        "kill -INT $!; wait $!; echo status $?\n",
        folder);
    EXPECT_TRUE(has(output.out, "interrupted\n")) << output.out << output.err;
    EXPECT_TRUE(has(output.out, "status 130\n")) << output.out << output.err;
}

// The first run reads the line, and the second waits for another.
TEST(Try, SaysWhatWasMeasuredBeforeARunThatIsInterruptedAsItStarts) {
    const TemporaryFolder folder;
    const Output output = runScript(
        "mkfifo $folder/input; exec 3<>$folder/input; echo go >&3; echo on >&3\n"
        "$try --json $folder/json -- $stock waits-for-input <&3 2>$folder/progress &\n"
        "until grep -q 'run 2 of 2' $folder/progress; do sleep 0.05; done\n"
        "kill $!; wait $!; echo status $?; cat $folder/json\n",
        folder);
    EXPECT_TRUE(has(output.out, "status 143\n")) << output.out << output.err;
    EXPECT_EQ(countOf(output.out, "\"broadphase\": \"bullet\""), 1U) << output.out;
    EXPECT_EQ(countOf(output.out, "\"broadphase\": \"hashphase\""), 0U) << output.out;
}

TEST(Try, SaysWhatWasMeasuredInTheFirstRunAlone) {
    const TemporaryFolder folder;
    const Output output = runScript(
        "$try --quiet -- $stock endless & sleep 0.5\nkill $!; wait $!; echo status $?\n", folder);
    EXPECT_TRUE(has(output.out, "There was no run with hashphase. With Bullet's broadphase, "))
        << output.out << output.err;
    EXPECT_TRUE(has(output.out, "status 143\n")) << output.out << output.err;
}

TEST(Try, LeavesSignalsIgnoredThatAre) {
    const TemporaryFolder folder;
    const Output output = runScript(
        "env --ignore-signal=HUP $try --quiet --seconds 0.5 -- $stock endless & sleep 0.3\n"
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
    EXPECT_EQ(countOf(output.out, "With hashphase a step of "), 2U) << output.out << output.err;
}

}  // namespace
}  // namespace hashphase::demos
