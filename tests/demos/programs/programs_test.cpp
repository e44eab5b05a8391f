// SPDX-License-Identifier: Zlib

// The programs as the shell runs them: interrupted, and with results that go to a full disk or to stdout.

#include <tests/support/shell.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <string>

namespace hashphase::demos {
namespace {

using Json = nlohmann::json;

class Programs : public testing::Test {
protected:
    [[nodiscard]] ScriptOutput run(const std::string& script) const {
        return runInFolder(folder_, "hashphase=" HASHPHASE_PROGRAM "\n" + script);
    }

    /// Sends SIGINT to `$hashphase words` as soon as it has opened `result`, in which there are older results.
    [[nodiscard]] ScriptOutput interrupted(const std::string& words,
                                           const std::string& result) const {
        std::filesystem::create_directories(folder_.path() / "o");
        folder_.write(result, "older");
        return run("env --default-signal=INT $hashphase " + words + " >out &\n" +
                   interruptOnce("[ -e " + result + ".partial ]") +
                   "wait $!; status=$?; cat out; exit $status");
    }
    [[nodiscard]] std::string text(const std::string& name) const {
        std::ifstream file(folder_.file(name));
        return {std::istreambuf_iterator<char>(file), {}};
    }
    [[nodiscard]] Json json(const std::string& name) const {
        return Json::parse(text(name), nullptr, false);
    }
    void expectNothingPartial() const {
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path())) {
            EXPECT_NE(entry.path().extension(), ".partial") << entry.path();
        }
    }
    static void expectIn(const std::string& text, const std::string& part) {
        EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
    }

    TemporaryFolder folder_;
};

TEST_F(Programs, CompareEndsWithWhatItMeasuredWhenItIsInterrupted) {
    const ScriptOutput ended = interrupted(
        "compare --objects 200 --frames 1000000 --broadphases hash,dbvt --quiet --json r.json "
        "--html r.html",
        "r.json");
    EXPECT_EQ(ended.status, 130) << ended.err;
    expectIn(ended.out, "The run was interrupted after ");
    expectIn(ended.err, "hashphase: the run was interrupted.\n");
    EXPECT_EQ(json("r.json")["verdict"]["interrupted"], true);
    const std::string page = text("r.html");
    expectIn(page, "The run was interrupted after ");
    EXPECT_TRUE(page.ends_with("</html>\n"));
    expectNothingPartial();
}

TEST_F(Programs, AccuracyEndsWithWhatItMeasuredWhenItIsInterrupted) {
    const ScriptOutput ended = interrupted("accuracy --quiet --output o", "o/accuracy.html");
    EXPECT_EQ(ended.status, 130) << ended.err;
    expectIn(ended.out, "; interrupted, which left out ");
    expectIn(text("o/accuracy.html"), "; interrupted, which left out ");
    expectNothingPartial();
}

TEST_F(Programs, EffectsPaperStabilityAndReportAreInterruptedToo) {
    for (const std::string& words :
         {std::string("effects --quiet --objects 200 --frames 1000000 --json r.json"),
          std::string("paper --quiet --json r.json"),
          std::string("stability --quiet --json r.json"),
          std::string("report --quiet --html r.json")}) {
        const ScriptOutput ended = interrupted(words, "r.json");
        EXPECT_EQ(ended.status, 130) << words << '\n' << ended.err;
        expectIn(ended.err, "hashphase: the run was interrupted.\n");
        expectNothingPartial();
        const std::string left = text("r.json");
        // Before the end, effects has no result.
        EXPECT_EQ(left == "older", words.starts_with("effects")) << words;
        EXPECT_TRUE(left == "older" || Json::accept(left) || left.ends_with("</html>\n")) << left;
    }
}

// It waits to open a pipe that nothing reads, and would wait for ever.
TEST_F(Programs, EndAtOnceTheSecondTime) {
    const ScriptOutput ended =
        run("mkfifo pipe\n"
            "env --default-signal=INT $hashphase compare --objects 9 --frames 1 --json r.json "
            "--csv pipe "
            "2>said &\n" +
            interruptOnce("[ -e r.json.partial ]") +
            interruptOnce("grep -q 'Ctrl-C again ends at once' said") + "wait $!");
    EXPECT_EQ(ended.status, 130);
}

TEST_F(Programs, SayThatResultsAreLostOnAFullDisk) {
    const ScriptOutput lost =
        run("for words in --help --version 'compare --list' 'accuracy --list' 'effects --list' "
            "'stability --list' 'paper --help' 'compare --objects 9 --frames 1'; do\n"
            "    $hashphase $words >/dev/full; echo $?\n"
            "done");
    EXPECT_EQ(lost.out, "2\n2\n2\n2\n2\n2\n2\n2\n") << lost.err;
    expectIn(lost.err, "the standard output cannot be written to its end, so results are lost");
}

TEST_F(Programs, LeaveTheLastGoodFilesOnAFullDisk) {
    folder_.write("r.html", "the last good one");
    const ScriptOutput full = run(
        "ulimit -f 8\n"  // of 512 bytes
        "$hashphase compare --objects 50 --frames 12 --html r.html >out; echo $?; cat r.html; ls");
    EXPECT_EQ(full.out,
              "2\nthe last good one"
              "err\nout\nr.html\nscript\n")
        << full.err;
    expectIn(full.err, "hashphase: r.html cannot be written to its end; is the disk full?\n");
}

TEST_F(Programs, WriteTheOtherFilesIfOneCannotBeWritten) {
    for (const char* words :
         {"compare --objects 9 --frames 1", "paper --quick --objects 500 --time-limit 0.1",
          "effects --objects 9 --frames 2", "stability --only H16 --broadphases hash"}) {
        const ScriptOutput full = run("rm -f r.*\n$hashphase " + std::string(words) +
                                      " --quiet --json /dev/full --csv r.csv --html r.html");
        EXPECT_EQ(full.status, 2) << words << '\n' << full.err;
        EXPECT_EQ(full.err,
                  "hashphase: /dev/full cannot be written to its end; is the disk full?\n")
            << words;
        EXPECT_NE(text("r.csv").find('\n'), std::string::npos) << words;
        EXPECT_TRUE(text("r.html").ends_with("</html>\n")) << words;
    }
}

TEST_F(Programs, WriteResultsToStdoutBehindTheReport) {
    for (const std::string& where : {std::string(" | cat"), std::string(" >out; cat out")}) {
        const ScriptOutput both =
            run("$hashphase compare --objects 50 --frames 4 --json /dev/stdout" + where);
        const std::size_t begin = both.out.find("\n{\n");
        ASSERT_NE(begin, std::string::npos) << both.out;
        expectIn(both.out.substr(0, begin), "pair sets exact in every frame: yes");
        EXPECT_EQ(Json::parse(both.out.substr(begin))["schema"], "hashphase-compare");
    }
}

}  // namespace
}  // namespace hashphase::demos
