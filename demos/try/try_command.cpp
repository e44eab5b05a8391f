// SPDX-License-Identifier: Zlib
#include <demos/try/try_command.hpp>

#include <demos/console/options.hpp>
#include <demos/console/subcommands.hpp>
#include <demos/try/try.hpp>

#include <CLI/CLI.hpp>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace hashphase::demos {
namespace {

void declare(CLI::App& app, TryOptions& options) {
    app.footer(
        "hashphase try [OPTIONS] -- PROGRAM [ARGUMENT]...\n\n"
        "PROGRAM links Bullet's shared libraries, and makes its broadphase from btDbvtBroadphase, "
        "btAxisSweep3 or\nbt32BitAxisSweep3. With ours in place, the trees in "
        "btDbvtBroadphase::m_sets are empty for programs that\nwalk them themselves. "
        "Ctrl-C ends the program, and further runs.\n"
        "Times are the processor time of the thread that makes the steps: other programs do not "
        "lengthen it.");
    CLI::Option* verify = app.add_flag(
        "--verify", options.verify,
        "one run with ours at work and Bullet's beside it: compare the pairs of both with the "
        "exact ones in every step");
    app.add_option("--runs", options.runs, "so many runs with each broadphase, by turns")
        ->capture_default_str()
        ->transform(wholeFrom(1, 1000))
        ->excludes(verify);
    app.add_option("--steps", options.steps, "end the program after so many steps")
        ->transform(wholeFrom(1, tryout::Record::kMaxRows));
    app.add_option("--seconds", options.seconds, "end the program after so many seconds")
        ->transform(positiveSeconds());
    app.add_option_function<std::string>(
           "--precision",
           [&options](const std::string& name) {
               options.precision =
                   name == "single" ? BulletPrecision::kSingle : BulletPrecision::kDouble;
           },
           "of the Bullet that the program loads as it runs")
        ->check(CLI::IsMember({"single", "double"}))
        ->type_name("NAME");
    addFileToWrite(app, "--json", options.jsonFile, "write everything measured to this file");
    app.add_flag("--quiet", options.quiet, "say nothing but the results and what is waited for");
}

}  // namespace

Subcommand tryCommand() {
    auto options = std::make_shared<TryOptions>();
    Subcommand command;
    command.name = "try";
    command.description = descriptionOf(command.name);
    command.declareOptions = [options](CLI::App& app) { declare(app, *options); };
    command.takeRest = [options](std::vector<std::string> words) {
        options->words = std::move(words);
    };
    command.run = [options](Console& console) { return runTry(*options, console); };
    return command;
}

}  // namespace hashphase::demos
