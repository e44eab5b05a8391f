// SPDX-License-Identifier: Zlib

// What is left of a program that is interrupted, or has no time.

#include <tests/benchmarks/benchmark_command.hpp>
#include <tests/demos/interruptible.hpp>
#include <tests/support/shell.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace hashphase::benchmarks {
namespace {

using demos::TemporaryFolder;
using nlohmann::json;

/// Finds nothing in scenes that have no pairs; somebody presses Ctrl-C in its fifth frame.
class InterruptedContestant : public Contestant {
public:
    void fill(const FrameBoxes& /*frame*/) override {}
    void setAll(const FrameBoxes& /*frame*/) override {}
    void findPairs() override {
        if (++frames_ == 5) {
            std::raise(SIGINT);
        }
    }
    void listPairs(std::vector<demos::PairKey>& pairs) override { pairs.clear(); }

private:
    int frames_ = 0;
};

const std::vector<ContestantKind> kInterrupted{
    {.name = "hash",
     .title = "a fake",
     .package = "none",
     .make = [](const demos::BroadphaseNeeds&) {
         return std::make_unique<InterruptedContestant>();
     }}};

struct Ended {
    int exitCode;
    std::string out;
};

Ended runInterrupted(const std::vector<std::string>& arguments) {
    std::ostringstream out;
    const int exitCode = demos::runSingleCommand(arguments, benchmarkCommand(kInterrupted),
                                                 {out, out, false, "test"});
    return {exitCode, out.str()};
}

TEST(InterruptedBenchmarks, ReportWhatTheyMeasuredUntilThen) {
    const TemporaryFolder folder;
    const std::string path = folder.write("r.json", "older");
    const Ended ended = runInterrupted(
        {"--only", "S2", "--sizes", "1,2", "--frames", "100", "--quiet", "--json", path});
    EXPECT_EQ(ended.exitCode, 130);
    for (const char* said : {"\nThe run was interrupted after 0 frames.\n",
                             "\nThe run was interrupted: 1 of 2 cases are left out.\nAll answers "
                             "of ours exact: yes\n"}) {
        EXPECT_NE(ended.out.find(said), std::string::npos) << said << ended.out;
    }
    const json report = json::parse(std::ifstream(path));
    EXPECT_EQ(report["verdict"]["interrupted"], true);
    EXPECT_EQ(report["verdict"]["casesDone"], 1);
}

TEST(InterruptedBenchmarks, SayThatThereWasNoTimeForACase) {
    const Ended ended = runInterrupted({"--only", "S2", "--sizes", "1", "--time-limit", "1e-9"});
    EXPECT_EQ(ended.exitCode, demos::kExitCheckFailed);
    EXPECT_NE(ended.out.find("\nThe time limit of 1e-09 s was reached before the first case.\n"),
              std::string::npos)
        << ended.out;
}

// As the shell starts it. The signal may come before the first case.
TEST(InterruptedBenchmarks, EndTheProgramWithTheSignalsStatus) {
    const TemporaryFolder folder;
    const demos::ScriptOutput ended = demos::runInFolder(
        folder,
        "env --default-signal=INT '" HASHPHASE_BENCHMARKS_PROGRAM
        "' --only S2 --sizes 100 --frames 1000000 --contestants hash,dbvt --quiet --json r.json "
        ">out &\n" +
            demos::interruptOnce("[ -e r.json.partial ] && sleep 0.2") +
            "wait $!; status=$?; cat out; exit $status");
    EXPECT_EQ(ended.status, 130) << ended.err;
    EXPECT_NE(ended.err.find("hashphase: the run was interrupted.\n"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(folder.file("r.json.partial")));
    if (std::filesystem::exists(folder.file("r.json"))) {
        EXPECT_NE(ended.out.find("The run was interrupted after "), std::string::npos) << ended.out;
        EXPECT_EQ(json::parse(std::ifstream(folder.file("r.json")))["verdict"]["interrupted"],
                  true);
    }
}

}  // namespace
}  // namespace hashphase::benchmarks
