// SPDX-License-Identifier: Zlib
//
// Pages of the subcommands, at a small size: what is measured in which unit.

#include <demos/compare/compare_command.hpp>
#include <demos/effects/effects_command.hpp>
#include <demos/paper/paper_command.hpp>
#include <demos/report/page.hpp>
#include <tests/demos/units.hpp>

#include <gtest/gtest.h>

#include <sstream>

namespace hashphase::demos {
namespace {

/// The page of a command that is run so.
Page pageOf(Subcommand command, std::vector<std::string> arguments) {
    Page page;
    std::ostringstream out;
    Console console{out, out, false, command.name};
    console.takePage = [&page](const Page& taken) { page = taken; };
    arguments.emplace_back("--quiet");
    EXPECT_EQ(runSingleCommand(std::move(arguments), command, console), kExitOk) << out.str();
    return page;
}

TEST(Units, AreThoseOfEveryNumberOnAPage) {
    for (const Page& page :
         {pageOf(compareCommand(), {"--scene", "stack", "--objects", "40", "--frames", "8"}),
          pageOf(effectsCommand(), {"--objects", "200", "--frames", "3"}),
          pageOf(paperCommand(), {"--quick", "--objects", "500", "--frames", "2"})}) {
        SCOPED_TRACE(page.title);
        EXPECT_GT(page.sections.size(), 0U);
        for (const PageSection& section : page.sections) {
            expectUnits(section);
        }
    }
}

TEST(Units, AreMissedWhereThereAreNone) {
    EXPECT_FALSE(hasUnit("calculate"));
    EXPECT_FALSE(hasUnit("theory: r (1 - n_y)"));
    EXPECT_FALSE(hasUnit("both, worst frame"));
    EXPECT_FALSE(hasUnit("whole step"));
    EXPECT_TRUE(hasUnit("frame"));
    EXPECT_TRUE(hasUnit("calculate [ms]"));
    EXPECT_TRUE(hasUnit("listed pairs"));
}

}  // namespace
}  // namespace hashphase::demos
