// SPDX-License-Identifier: Zlib
#include <demos/stability/stability_command.hpp>

#include <demos/console/options.hpp>
#include <demos/stability/stability.hpp>

#include <CLI/CLI.hpp>

namespace hashphase::demos {
namespace {

void declareStability(CLI::App& app, StabilityOptions& options) {
    app.add_option("--only", options.only, "run these cases, separated by commas (see --list)")
        ->delimiter(',');
    app.add_option("--broadphases", options.broadphases,
                   "run these broadphases, separated by commas (see --list)")
        ->delimiter(',');
    app.add_flag("--quick", options.isQuick, "run smaller inputs: some seconds for all");
    app.add_flag("--explain", options.isExplained,
                 "tell of each case what is handed in, what is required, and what each one does");
    app.add_option("--seed", options.seed, "seed of all random numbers")
        ->transform(seedUpTo())
        ->capture_default_str();
    app.add_option("--case-time-limit", options.caseSeconds,
                   "seconds of processor time that a broadphase has for a case (ours ten times "
                   "that)")
        ->transform(positiveSeconds())
        ->capture_default_str();
    app.add_option("--time-limit", options.timeLimit, "after so many seconds begin no other case")
        ->transform(positiveSeconds());
    addFileToWrite(app, "--json", options.jsonFile, "write everything found to this file");
    addFileToWrite(app, "--csv", options.csvFile,
                   "write a row for each case and broadphase to this file");
    addFileToWrite(app, "--html", options.htmlFile, "write a page with the table to this file");
    app.add_flag("--quiet", options.quiet, "no progress on stderr");
    app.add_flag("--list", options.list, "say which cases and broadphases there are");
}

}  // namespace

Subcommand stabilityCommand(std::span<const BroadphaseKind> kinds,
                            std::span<const HardCase> cases) {
    return makeSubcommand<StabilityOptions>("stability", declareStability,
                                            [kinds, cases](const auto& options, Console& console) {
                                                return runStability(options, kinds, cases, console);
                                            });
}

}  // namespace hashphase::demos
