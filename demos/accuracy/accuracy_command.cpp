// SPDX-License-Identifier: Zlib
#include <demos/accuracy/accuracy_command.hpp>

#include <demos/console/options.hpp>
#include <demos/console/subcommands.hpp>

#include <CLI/CLI.hpp>

#include <memory>

namespace hashphase::demos {
namespace {

void declare(CLI::App& app, AccuracyOptions& options) {
    app.add_option("--only", options.only,
                   "run these experiments, separated by commas (see --list)")
        ->delimiter(',');
    app.add_flag("--quick", options.effort.isQuick,
                 "measure less: under a minute for all, in place of some ten");
    addFolderToWrite(app, "--output", options.folder,
                     "write the report (accuracy.html) and its data (JSON, CSV) to this folder");
    app.add_option("--seed", options.effort.seed, "seed of all random numbers")
        ->transform(seedUpTo())
        ->capture_default_str();
    app.add_option("--time-limit", options.timeLimit,
                   "after so many seconds begin no other experiment")
        ->transform(positiveSeconds());
    app.add_flag("--quiet", options.quiet, "no progress on stderr");
    app.add_flag("--list", options.list, "say which experiments there are");
}

}  // namespace

Subcommand accuracyCommand(std::span<const Experiment> known) {
    auto options = std::make_shared<AccuracyOptions>();
    Subcommand command;
    command.name = "accuracy";
    command.description = descriptionOf(command.name);
    command.declareOptions = [options](CLI::App& app) { declare(app, *options); };
    command.run = [options, known](Console& console) {
        return runAccuracy(*options, known, console);
    };
    return command;
}

}  // namespace hashphase::demos
