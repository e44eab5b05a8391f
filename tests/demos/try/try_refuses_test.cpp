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
    const Output output = runCommand(kTry + arguments, folder);
    EXPECT_EQ(output.status, kExitUsage) << output.out << output.err;
    EXPECT_TRUE(has(output.err, sentence)) << output.err;
}

TEST(TryRefuses, ScriptsAndTexts) {
    const TemporaryFolder folder;
    const std::string script = folder.write("script", "#!/bin/sh\necho\n");
    const std::string text = folder.write("text", "nothing that runs");
    for (const std::string& file : {script, text}) {
        std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    }
    expectRefused("-- '" + script + "'", "is a script; name the program that it starts", folder);
    expectRefused("-- '" + text + "'", "is no 64-bit program for this machine", folder);
}

/// By a program that links no Bullet, and loads that plugin as it runs.
Output tryPlugin(const std::string& options, const std::string& plugin, const std::string& name) {
    return runCommand(kTry + "--quiet " + options + " -- " + stock("stock-host") + " " +
                      stock(plugin) + " " + name);
}

TEST(TryRefuses, AWrongPrecision) {
    if (!std::filesystem::exists(stock("stock-programs-float64"))) {
        GTEST_SKIP() << "there is no library for double precision";
    }
    for (const std::string name : {"churn", "sweep-16", "derived-sweep"}) {
        const Output output = tryPlugin("--precision double", "libstock-programs-plugin.so", name);
        EXPECT_TRUE(has(output.err, "the program and hashphase use two Bullets, those of /"))
            << name << output.err;
        EXPECT_NE(output.status, kExitOk);
    }
}

TEST(TryRefuses, APluginWithABulletOfItsOwn) {
    const std::string plugin = "libstock-programs-embedding-plugin.so";
    const Output output = tryPlugin("--precision single", plugin, "churn");
    EXPECT_TRUE(has(output.err, " and " + stock(plugin) +
                                    "; is the precision right, and is none of them linked "
                                    "statically?"))
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

// A folder that is none; and a limit on the length of files, which is no reason to leave the one that was made.
TEST(TryRefuses, WithoutRoomForItsFile) {
    const TemporaryFolder folder;
    const std::string limited = "ulimit -f 1000; TMPDIR='" + folder.path().string() + "' ";
    for (const std::string& place : {std::string("TMPDIR=/no/such/folder "), limited}) {
        const Output output = runCommand(place + kTry + "-- " + kStock + "pile", folder);
        EXPECT_EQ(output.status, kExitUsage);
        EXPECT_TRUE(has(output.err, "can be made in the folder of temporary files")) << output.err;
    }
    EXPECT_EQ(countOf(runCommand("ls '" + folder.path().string() + "'").out, "hashphase-try"), 0U);
}

// What was measured before is not lost for a word that is misspelt.
TEST(TryRefuses, LeavesAnEarlierResult) {
    const TemporaryFolder folder;
    const std::string earlier = folder.write("try.json", "{}");
    expectRefused("--json '" + earlier + "' -- /no/such/program", "is no program", folder);
    EXPECT_EQ(runCommand("cat '" + earlier + "'").out, "{}");
}

TEST(TryTakesOver, LeavesSweepsAloneThatAreCalledDirectly) {
    const std::string call = kStock + "bare-sweep";
    const Output plain = runCommand(call);
    const Output output = runCommand(kTry + "--quiet -- " + call);
    EXPECT_EQ(output.status, kExitCheckFailed) << output.out;  // nothing was compared
    EXPECT_EQ(countOf(output.out, plain.out), 2U) << plain.out << output.out;
}

TEST(TryTakesOver, TakesOverABulletThatIsLoadedLater) {
    for (const auto& [precision, name] :
         {std::pair("single", "stock-programs"), std::pair("double", "stock-programs-float64")}) {
        if (!std::filesystem::exists(stock(name))) {
            continue;
        }
        const std::string options = std::string("--precision ") + precision;
        const std::string call =
            stock("stock-host") + " " + stock(std::string("lib") + name + "-plugin.so") + " churn";
        const auto [output, json] = measure("--verify " + options, call);
        EXPECT_EQ(output.status, kExitOk) << output.out << output.err;
        EXPECT_EQ(json["verification"]["calculations"], 200);
        const auto [compared, figures] = measure(options, call);
        EXPECT_EQ(figures["runs"][1]["steps"].size(), 200U) << compared.out;
    }
}

}  // namespace
}  // namespace hashphase::demos
