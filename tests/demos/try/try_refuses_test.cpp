// SPDX-License-Identifier: Zlib

// What `hashphase try` says of programs that it cannot take over, or not all of.

#include <tests/demos/try/try_output.hpp>

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>

#include <sys/prctl.h>
#include <sys/statvfs.h>

namespace hashphase::demos {
namespace {

void expectRefused(const std::string& arguments, const std::string& sentence,
                   const TemporaryFolder& folder = {}) {
    const Output output = tryProgram(arguments, folder);
    EXPECT_EQ(output.status, kExitUsage) << output.out << output.err;
    EXPECT_TRUE(has(output.err, sentence)) << output.err;
}

TEST(TryRefuses, WhatIsNoProgram) {
    expectRefused("", "name a program to try: hashphase try -- ./program");
    expectRefused("-- no-such-program-anywhere",
                  "'no-such-program-anywhere' was not found in PATH");
    expectRefused("-- './[no,such]-program'",
                  "'./[no,such]-program' is no program that can be run");
    expectRefused("--no-such-option -- ls", "There is no option '--no-such-option'");
    const TemporaryFolder folder;
    const std::string script = folder.write("script", "#!/bin/sh\necho\n");
    const std::string text = folder.write("text", "nothing that runs");
    for (const std::string& file : {script, text}) {
        std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    }
    expectRefused("''", "'' belongs behind --: hashphase try [options] -- ");
    expectRefused("ls", "'ls' belongs behind --: hashphase try [options] -- ls");
    expectRefused("--precision 1 -- ls", "{single,double}");
    expectRefused("-- '" + script + "'", "is a script; name the program that it starts", folder);
    expectRefused("-- '" + text + "'", "is no 64-bit program for this machine", folder);
}

TEST(TryRefuses, ProgramsWithoutASharedBulletOfThisVersion) {
    expectRefused("-- " + stock("stock-static"), "is linked statically as a whole");
    expectRefused("-- " + stock("stock-host"), "links no Bullet");
    expectRefused("-- " + stock("stock-embedded"), "Bullet is linked statically into ");
    expectRefused("--precision single -- " + stock("stock-embedded"),
                  "Bullet is linked statically into ");
    expectRefused("--precision double -- " + stock("stock-programs") + " pile",
                  "is of single precision, and not double");
    expectRefused("-- " + stock("stock-old"),
                  " links libBulletCollision.so.2.83, and this hashphase was built with "
                  "libBulletCollision.so.");
}

TEST(TryRefuses, ProgramsThatMakeNoBroadphaseOfThese) {
    expectRefused("-- " + stock("stock-programs") + " simple-broadphase",
                  "ended with status 0, and has made no btDbvtBroadphase and no axis sweep");
}

TEST(TryRefuses, ProgramsThatCrashBeforeTheyMakeABroadphase) {
    for (const std::string mode : {"", "--verify "}) {
        const Output output =
            tryProgram("--quiet " + mode + "-- " + stock("stock-programs") + " crashing-at-once");
        EXPECT_EQ(output.status, kExitUsage);
        EXPECT_TRUE(lastLineOf(output.err).ends_with("when it was ended by signal 6 (Aborted)"))
            << output.err;
    }
}

TEST(TryRefuses, ClassesDerivedFromASweep) {
    expectRefused("-- " + stock("stock-programs") + " derived-sweep",
                  "has made no btDbvtBroadphase and no axis sweep that can be taken over");
}

TEST(Try, SaysWhenThePrecisionIsWrong) {
    if (!std::filesystem::exists(stock("stock-programs-float64"))) {
        GTEST_SKIP() << "there is no library for double precision";
    }
    const std::string plugin = stock("libstock-programs-plugin.so");
    for (const std::string name : {"churn", "sweep-16", "derived-sweep"}) {
        const Output output = tryProgram("--quiet --precision double -- " + stock("stock-host") +
                                         " " + plugin + " " + name);
        EXPECT_TRUE(has(output.err, "the program and hashphase use two Bullets, those of /"))
            << name << output.err;
        EXPECT_NE(output.status, kExitOk);
    }
}

TEST(Try, SaysWhenAPluginHasABulletOfItsOwn) {
    const std::string plugin = stock("libstock-programs-embedding-plugin.so");
    const Output output = tryProgram("--quiet --precision single -- " + stock("stock-host") + " " +
                                     plugin + " churn");
    EXPECT_TRUE(
        has(output.err,
            " and " + plugin + "; is the precision right, and is none of them linked statically?"))
        << output.err;
    EXPECT_NE(output.status, kExitOk);
}

TEST(TryRefuses, ProgramsThatDoNotLoadWhatIsPreloaded) {
    const TemporaryFolder folder;
    struct statvfs place {};
    if (statvfs(folder.path().c_str(), &place) != 0 || (place.f_flag & ST_NOSUID) != 0 ||
        prctl(PR_GET_NO_NEW_PRIVS, 0, 0, 0, 0) != 0) {
        GTEST_SKIP() << "no program gets the rights of another user here";
    }
    const std::string program = folder.file("program");
    if (runCommand("cp " + stock("stock-host") + " '" + program + "' && chown nobody '" + program +
                       "' && chmod u+s '" + program + "'",
                   folder)
            .status != 0) {
        GTEST_SKIP() << "only root can give a program the rights of another user";
    }
    expectRefused("--precision single -- '" + program + "'", "has not loaded what was preloaded",
                  folder);
}

// The file is made, and a limit on its length is no reason to leave it.
TEST(TryRefuses, FilesThatMayNotBeSoLong) {
    const TemporaryFolder folder;
    const Output output =
        runCommand("ulimit -f 1000; TMPDIR='" + folder.path().string() + "' " + HASHPHASE_PROGRAM +
                       " try -- " + stock("stock-programs") + " pile",
                   folder);
    EXPECT_EQ(output.status, kExitUsage);
    EXPECT_TRUE(has(output.err, "can be made in the folder of temporary files")) << output.err;
    EXPECT_EQ(countOf(runCommand("ls '" + folder.path().string() + "'").out, "hashphase-try"), 0U);
}

// What was measured before is not lost for a word that is misspelt.
TEST(TryRefuses, LeavesAnEarlierResult) {
    const TemporaryFolder folder;
    const std::string earlier = folder.write("try.json", "{}");
    expectRefused("--json '" + earlier + "' -- /no/such/program", "is no program", folder);
    EXPECT_EQ(runCommand("cat '" + earlier + "'").out, "{}");
}

TEST(TryRefuses, FoldersOfTemporaryFilesThatAreNone) {
    const TemporaryFolder folder;
    const Output output = runCommand(std::string("TMPDIR=/no/such/folder ") + HASHPHASE_PROGRAM +
                                         " try -- " + stock("stock-programs") + " pile",
                                     folder);
    EXPECT_EQ(output.status, kExitUsage);
    EXPECT_TRUE(has(output.err, "can be made in the folder of temporary files")) << output.err;
}

TEST(Try, LeavesSweepsAloneThatAreCalledDirectly) {
    const std::string call = stock("stock-programs") + " bare-sweep";
    const Output plain = runCommand(call);
    const Output output = tryProgram("--quiet -- " + call);
    EXPECT_EQ(output.status, kExitCheckFailed) << output.out;  // nothing was compared
    EXPECT_EQ(countOf(output.out, plain.out), 2U) << plain.out << output.out;
}

TEST(Try, TakesOverABulletThatIsLoadedLater) {
    for (const auto& [precision, name] :
         {std::pair("single", "stock-programs"), std::pair("double", "stock-programs-float64")}) {
        if (!std::filesystem::exists(stock(name))) {
            continue;
        }
        const std::string plugin = stock(std::string("lib") + name + "-plugin.so");
        const auto [output, json] = measure(std::string("--verify --precision ") + precision,
                                            stock("stock-host") + " " + plugin + " churn");
        EXPECT_EQ(output.status, kExitOk) << output.out << output.err;
        EXPECT_EQ(json["verification"]["calculations"], 200);
        const auto [compared, figures] = measure(std::string("--precision ") + precision,
                                                 stock("stock-host") + " " + plugin + " churn");
        EXPECT_EQ(figures["runs"][1]["steps"].size(), 200U) << compared.out;
    }
}

TEST(Try, SaysWhichBroadphasesItDoesNotTakeOver) {
    const auto [output, json] = measure("", stock("stock-programs") + " mixed");
    EXPECT_EQ(json["runs"][0]["foreignCalculations"], 10);
    EXPECT_EQ(json["runs"][0]["steps"].size(), 10U);
    EXPECT_TRUE(has(output.out, "10 calculations of pairs were those of broadphases that are not"))
        << output.out;
}

}  // namespace
}  // namespace hashphase::demos
