// SPDX-License-Identifier: Zlib

// The values of options, of all subcommands alike: nothing is taken in silence that was not meant, and
// what is meant is taken however it is written.

#include <demos/accuracy/accuracy_command.hpp>
#include <demos/compare/compare_command.hpp>
#include <demos/console/format.hpp>
#include <demos/console/options.hpp>
#include <demos/effects/effects_command.hpp>
#include <demos/paper/paper_command.hpp>
#include <demos/report/report_command.hpp>
#include <demos/scenes/file_bytes.hpp>
#include <demos/stability/stability_command.hpp>
#include <tests/demos/typed.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>

#include <iterator>
#include <sstream>
#include <utility>

namespace hashphase::demos {
namespace {

std::vector<Subcommand> allSubcommands() {
    return {compareCommand(), paperCommand(),     accuracyCommand({}),
            effectsCommand(), stabilityCommand(), reportCommand({})};
}

Typed typed(const std::vector<std::string>& arguments) {
    return typed(arguments, allSubcommands());
}

std::string refusalOf(const std::vector<std::string>& arguments) {
    const Typed outcome = typed(arguments);
    EXPECT_EQ(outcome.exitCode, kExitUsage) << testing::PrintToString(arguments);
    EXPECT_EQ(outcome.out, "") << testing::PrintToString(arguments);
    return outcome.err;
}

TEST(NumberWords, AreReadHoweverTheyAreWritten) {
    for (const char* word :
         {"100000", "1e5", "1E5", "+1e+05", "100,000", "100_000", "100'000", "0100000", "1000e2",
          "0.1e6", "100000.0", " 100000\t", "10000000e-2"}) {
        EXPECT_EQ(wholeNumber(word), 100'000U) << word;
        EXPECT_EQ(finiteNumber(word), 100'000.0) << word;
    }
    EXPECT_EQ(wholeNumber("0"), 0U);
    EXPECT_EQ(wholeNumber("0e999"), 0U);
    EXPECT_EQ(wholeNumber("18446744073709551615"), 18'446'744'073'709'551'615U);
    EXPECT_EQ(wholeNumber("1.8446744073709551615e19"), 18'446'744'073'709'551'615U) << "exactly";
    EXPECT_EQ(wholeNumber("1,234,567"), 1'234'567U);
    EXPECT_EQ(finiteNumber("-1,234.5"), -1234.5);
    EXPECT_EQ(finiteNumber("2.5e-3"), 0.0025);
}

TEST(NumberWords, AreNoneWhereTheyCouldMeanSomethingElse) {
    std::istringstream words(
        "| |-1|0x10|1.5|15e-1|1,00|1,0000|,100|100,|1,000_000|1 "
        "000|1e|e5|1e5.0|--1|+-1|++1|many|1k|"
        ".|1.2.3|nan|inf|18446744073709551616|1e20|1e99|1e99999999999|1e+-5|"
        "1.00000000000000000000001|18446744073709551615.01");
    for (std::string word; std::getline(words, word, '|');) {
        EXPECT_EQ(wholeNumber(word), std::nullopt) << word;
    }
    for (const char* word : {"", "nan", "inf", "-inf", "1e999", "0x1p3", "1,5", "1.5s", "+-1"}) {
        EXPECT_EQ(finiteNumber(word), std::nullopt) << word;
    }
}

TEST(Options, TakeNoEmptyValueOfAnySubcommand) {
    std::size_t tried = 0;
    for (const Subcommand& subcommand : allSubcommands()) {
        CLI::App app;
        subcommand.declareOptions(app);
        for (const CLI::Option* option : app.get_options()) {
            if (option->get_items_expected_max() == 0) {
                continue;
            }
            for (const char* value : {"", "  "}) {
                const std::string name = option->get_name();
                const std::string fault = refusalOf({subcommand.name, name, value});
                EXPECT_EQ(fault.rfind("hashphase: " + name + ": ", 0), 0U) << fault;
                EXPECT_TRUE(fault.find("value is empty") != std::string::npos ||
                            (option->get_delimiter() == ',' &&
                             fault.find("value is missing") != std::string::npos))
                    << subcommand.name << ' ' << fault;
                ++tried;
            }
        }
    }
    EXPECT_GT(tried, 60U);
}

TEST(Options, SayWhatIsWrongInTheWordsThatWereTyped) {
    const std::vector<std::pair<std::string, std::string>> refused{
        {"compare --list --objects 0,-5,many,0x10,1e99,1.5,10000001,nan,inf",
         " is not a whole number from 1 to 10,000,000"},
        {"compare --list --seed -1", " is not a seed, which is a whole number from 0 to 2^64 - 1"},
        {"stability --list --time-limit -1,0,nan,inf,1e999,10s",
         " is not a number of seconds above 0"},
        {"paper --radius 1001", " is not a number of metres from 0 to 1000"},
        {"compare --file -",
         " names no file here; nothing is read from the standard input: save it to a file first"},
        {"compare --json -", " names no file here; name one, such as /dev/stdout"}};
    for (const auto& [line, sentence] : refused) {
        std::istringstream stream(line);
        std::vector<std::string> words{std::istream_iterator<std::string>(stream), {}};
        const std::string option = words[words.size() - 2];
        std::istringstream values(words.back());
        while (std::getline(values, words.back(), ',')) {
            EXPECT_EQ(refusalOf(words),
                      "hashphase: " + option + ": '" + words.back() + "'" + sentence + "\n");
        }
    }
}

TEST(Options, TakeNumbersHoweverTheyAreWritten) {
    for (const char* objects : {"1e2", "0100", "1_00"}) {
        const Typed outcome = typed(
            {"compare", "--objects", objects, "--frames", "2", "--broadphases", " hash , dbvt "});
        if (std::string(objects) == "1_00") {
            EXPECT_EQ(outcome.exitCode, kExitUsage);
        } else {
            EXPECT_NE(outcome.out.find("100 spheres, 2 frames"), std::string::npos) << outcome.err;
        }
    }
    const std::string scene = typed({"effects", "--show", "--objects", "1,500"}).out;
    EXPECT_NE(scene.find("\"objects\": 1500"), std::string::npos) << scene;
}

TEST(Options, AreRefusedWhenTheirFilesWouldOverwriteEachOther) {
    const TemporaryFolder folder;
    const std::string boxes = folder.write("boxes.txt", "0 0 0 1 1 1\n");
    EXPECT_EQ(refusalOf({"compare", "--file", boxes, "--json", folder.file("./boxes.txt")}),
              "hashphase: --json would be written over what --file reads: " + boxes + ".\n");
    EXPECT_EQ(readFile(boxes), "0 0 0 1 1 1\n");
    const std::string report = folder.file("report");
    EXPECT_EQ(refusalOf({"compare", "--json", report, "--html", folder.file(".") + "/report"}),
              "hashphase: --json and --html would both be written to " + report + ".\n");
    const std::string partial = folder.write("b.partial", "0 0 0 1 1 1\n");
    std::filesystem::create_symlink("b", folder.file("to b"));
    for (const std::string& name : {folder.file("b"), folder.file("to b")}) {
        EXPECT_EQ(
            refusalOf({"compare", "--file", partial, "--json", name}),
            "hashphase: --json would first be written to " + partial + ", which --file reads.\n");
    }
    EXPECT_EQ(refusalOf({"compare", "--csv", report + ".partial", "--json", report}),
              "hashphase: --json would first be written to " + report +
                  ".partial, which --csv writes, too.\n");
    EXPECT_EQ(readFile(partial), "0 0 0 1 1 1\n");
    std::filesystem::create_symlink(boxes, folder.file("link"));
    EXPECT_NE(refusalOf({"compare", "--file", folder.file("link"), "--csv", boxes}), "");
    EXPECT_EQ(typed({"compare", "--objects", "10", "--frames", "1", "--json", "/dev/null", "--csv",
                     "/dev/null"})
                  .exitCode,
              kExitOk)
        << "nothing is lost there";
}

TEST(Options, GivenTwiceOrWithoutAValueAreRefused) {
    EXPECT_EQ(refusalOf({"compare", "--objects", "5", "--objects", "6"}),
              "hashphase: --objects: it is given more than once\n");
    EXPECT_EQ(refusalOf({"compare", "--file", "a", "--file", "b"}),
              "hashphase: --file: it is given more than once\n");
    EXPECT_EQ(refusalOf({"compare", "--scene"}), "hashphase: --scene: its value is missing\n");
    EXPECT_EQ(refusalOf({"compare", "--broadphases", ","}),
              "hashphase: --broadphases: its value is missing\n");
}

TEST(Options, SayThatAFolderIsNoFile) {
    const TemporaryFolder folder;
    for (const char* option : {"--json", "--csv", "--html", "--file"}) {
        EXPECT_EQ(refusalOf({"compare", "--objects", "10", option, folder.file("")}),
                  "hashphase: " + folder.file("") + " is a folder, not a file.\n");
    }
}

}  // namespace
}  // namespace hashphase::demos
