// SPDX-License-Identifier: Zlib

// What all programs do alike: help, results that cannot be written, interruptions.

#include <demos/console/columns.hpp>
#include <demos/console/program.hpp>
#include <demos/report/report_text.hpp>
#include <demos/report/time_limit.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/system/interruption.hpp>
#include <tests/demos/interruptible.hpp>
#include <tests/demos/typed.hpp>

#include <gtest/gtest.h>
#include <CLI/CLI.hpp>

#include <csignal>
#include <ostream>
#include <sstream>
#include <streambuf>
#include <string>
#include <vector>

namespace hashphase::demos {
namespace {

/// A subcommand that does this.
Subcommand doing(std::function<int(Console&)> run) {
    Subcommand command;
    command.name = "compare";
    command.declareOptions = [](CLI::App& app) { app.add_flag("--sample"); };
    command.run = std::move(run);
    return command;
}

Typed typedOf(const std::vector<std::string>& arguments) {
    const Subcommand command = doing([](Console&) { return kExitOk; });
    return typed(arguments, std::span(&command, 1));
}

TEST(HelpWords, AreTakenAsTheOptionsAre) {
    for (const char* word : {"help", "-h", "--help"}) {
        const Typed general = typedOf({word});
        EXPECT_EQ(general.exitCode, kExitOk);
        EXPECT_TRUE(holds(general.out, "Usage: hashphase"));
        EXPECT_TRUE(holds(general.out, "  help [SUBCOMMAND] "));
        EXPECT_TRUE(holds(typedOf({word, "compare"}).out, "--sample"));
        EXPECT_EQ(typedOf({word, "help"}).out, general.out);
        EXPECT_EQ(typedOf({word, "--help"}).out, general.out);
    }
    EXPECT_EQ(typedOf({"version"}).out, typedOf({"--version"}).out);
    EXPECT_EQ(typedOf({"version"}).exitCode, kExitOk);
    EXPECT_EQ(typedOf({"help", "comprae"}).err,
              "hashphase: There is no subcommand 'comprae'; did you mean 'compare'?\n");
    EXPECT_EQ(typedOf({"hlep"}).err,
              "hashphase: There is no subcommand 'hlep'; did you mean 'help'?\n");
}

// --- Results that cannot be written --------------------------------------------------------------

/// A disk that is full.
struct FullBuffer : std::streambuf {
    int sync() override { return -1; }
};

TEST(FullOutput, EndsEveryProgramWithASentence) {
    const auto saidBy = [](const std::vector<std::string>& arguments, int ownCode) {
        FullBuffer buffer;
        std::ostream out(&buffer);
        std::ostringstream err;
        const Subcommand command = doing([ownCode](Console& console) {
            console.out << "results\n";
            return ownCode;
        });
        EXPECT_EQ(runProgram(arguments, std::span(&command, 1), {out, err, false, ""}), kExitUsage);
        return err.str();
    };
    const std::string sentence =
        "hashphase: the standard output cannot be written to its end, so results are lost; is the "
        "disk full?\n";
    for (const int ownCode : {kExitOk, kExitCheckFailed}) {
        EXPECT_EQ(saidBy({"compare"}, ownCode), sentence);
    }
    EXPECT_EQ(saidBy({"compare", "--help"}, kExitOk), sentence);
    EXPECT_EQ(saidBy({"--help"}, kExitOk), sentence);
    EXPECT_EQ(saidBy({"--version"}, kExitOk), sentence);
    EXPECT_EQ(saidBy({"compare"}, kExitUsage), "") << "which has said what is wrong";
}

TEST(Errors, AreMaskedForTheTerminal) {
    const Typed refused = typed(
        doing([](Console&) -> int { throw InputError("\x1b[2J\xff.png is a picture."); }), {});
    EXPECT_EQ(refused.err, "hashphase: ?[2J?.png is a picture.\n");
}

// --- Interruptions -------------------------------------------------------------------------------

TEST(Interruption, EndsACommandAsItsTimeLimitWithTheSignalsCode) {
    for (const auto& [signal, exitCode] : {std::pair{SIGINT, 130}, {SIGTERM, 143}, {SIGHUP, 129}}) {
        const Typed ended = typed(doing([number = signal](Console& console) {
                                      const TimeLimit limit(std::nullopt);
                                      EXPECT_FALSE(limit.isOver());
                                      EXPECT_EQ(interruptionText(), "");
                                      std::raise(number);
                                      EXPECT_TRUE(limit.isOver());
                                      EXPECT_EQ(limit.secondsLeft(), 0);
                                      EXPECT_EQ(limit.reason(), "The run was interrupted");
                                      console.out << "measured; " << interruptionText() << '\n'
                                                  << leftOutText({"A", "B"}) << leftOutText({});
                                      return kExitOk;
                                  }),
                                  {});
        EXPECT_EQ(ended.exitCode, exitCode);
        EXPECT_EQ(ended.out,
                  "measured; The run was interrupted: what it measured until then is here.\n"
                  "; interrupted, which left out A, B; interrupted");
        EXPECT_EQ(ended.err, "hashphase: the run was interrupted.\n");
        EXPECT_FALSE(isInterrupted()) << "the next one is not";
    }
}

TEST(Interruption, LeavesWorkThatHasNothingToShow) {
    const Typed left = typed(doing([](Console& console) {
                                 throwIfInterrupted();
                                 std::raise(SIGINT);
                                 throwIfInterrupted();
                                 console.out << "not reached";
                                 return kExitOk;
                             }),
                             {});
    EXPECT_EQ(left.exitCode, 130);
    EXPECT_EQ(left.out, "");
}

TEST(Interruption, IsNoneWhereTheSignalIsIgnored) {
    const auto before = std::signal(SIGHUP, SIG_IGN);
    const Typed whole = typed(doing([](Console&) {
                                  std::raise(SIGHUP);
                                  return kExitOk;
                              }),
                              {});
    std::signal(SIGHUP, before);
    EXPECT_EQ(whole.exitCode, kExitOk);
}

TEST(InterruptionDeathTest, EndsTheProcessTheSecondTimeUnlessThatIsNoted) {
    Subcommand command = doing([](Console&) {
        std::raise(SIGINT);
        std::raise(SIGTERM);
        return kExitOk;
    });
    EXPECT_EXIT(typed(command, {}), testing::KilledBySignal(SIGTERM), "Ctrl-C again ends at once");
    command.nextSignal = NotedSignals::Next::isNoted;
    EXPECT_EQ(typed(command, {}).exitCode, 143) << "the last one";
}

TEST(TimeLimits, AreOverAfterTheirSeconds) {
    const TimeLimit none(std::nullopt);
    EXPECT_GT(none.secondsLeft(), 1e300);
    const TimeLimit over(1e-9);
    EXPECT_TRUE(over.isOver());
    EXPECT_EQ(over.reason(), "The time limit of 1e-09 s was reached");
    EXPECT_FALSE(TimeLimit(1e9).isOver());
}

}  // namespace
}  // namespace hashphase::demos
