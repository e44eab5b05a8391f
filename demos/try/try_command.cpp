// SPDX-License-Identifier: Zlib
#include <demos/try/try_command.hpp>

#include <demos/console/format.hpp>
#include <demos/console/options.hpp>
#include <demos/console/result_file.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/system/interruption.hpp>
#include <demos/system/other_programs.hpp>
#include <demos/try/try_report.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <optional>
#include <ostream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <unistd.h>

namespace hashphase::demos {
namespace {

using tryout::Broadphase;

struct TryOptions {
    bool verify = false;
    std::string precision;  // empty: not said
    std::optional<std::uint32_t> steps;
    std::optional<double> seconds;
    int runs = 1;
    std::string jsonFile;
    bool quiet = false;
};

void declare(CLI::App& app, TryOptions& options) {
    app.footer(
        "hashphase try [OPTIONS] -- PROGRAM [ARGUMENT]...\n\n"
        "PROGRAM must link Bullet's shared libraries, and use btDbvtBroadphase, btAxisSweep3 or "
        "bt32BitAxisSweep3. While hashphase replaces them, the trees in btDbvtBroadphase::m_sets "
        "are empty: code that reads these trees finds no objects.\n"
        "Ctrl-C ends the program, skips further runs, and prints the results so far.\n"
        "Times are the processor time of the thread that makes the steps, so other programs do not "
        "lengthen them.");
    CLI::Option* verify = app.add_flag(
        "--verify", options.verify,
        "run once, with both broadphases, and compare the pairs of both with the exact pairs in "
        "every step");
    app.add_option("--runs", options.runs, "number of runs with each broadphase, alternating")
        ->capture_default_str()
        ->transform(wholeFrom(1, 1000))
        ->excludes(verify);
    app.add_option("--steps", options.steps, "end the program after this many steps")
        ->transform(wholeFrom(1, tryout::Record::kMaxRows));
    app.add_option("--seconds", options.seconds, "end the program after this many seconds")
        ->transform(positiveSeconds());
    app.add_option("--precision", options.precision,
                   "precision of Bullet, only for a program that loads Bullet while it runs "
                   "(dlopen); otherwise hashphase detects it")
        ->check(CLI::IsMember({"single", "double"}))
        ->type_name("NAME");
    addFileToWrite(app, "--json", options.jsonFile, "write all results to this file");
    app.add_flag("--quiet", options.quiet,
                 "print only results, and a notice if hashphase waits for processes that the "
                 "program left running");
}

// --- What is tried -------------------------------------------------------------------------------

// Where the libraries are when this is installed, and when it is built.
std::filesystem::path preloadFolder() {
    std::error_code error;
    const std::filesystem::path here =
        std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
    const std::filesystem::path installed = here / HASHPHASE_PRELOAD_FROM_PROGRAM;
    return std::filesystem::is_directory(installed, error) ? installed : here;
}

std::string preloadFor(const std::string& precision) {
    const char* name =
        precision == "single" ? "libhashphase-try.so" : "libhashphase-try-float64.so";
    return std::filesystem::weakly_canonical(preloadFolder() / name).string();
}

TriedRunSettings settingsFor(const TryOptions& options, const TriedProgram& program,
                             Console& console) {
    TriedRunSettings settings;
    settings.call = {
        program.path, console.rest, {}, options.steps, options.seconds, [&err = console.err] {
            err << "hashphase try: the program has ended, and has left others running; "
                   "waiting for these (Ctrl-C ends them)"
                << std::endl;
        }};
    const std::string preload = preloadFor(program.precision);
    // A script may have read some of it, and go on behind us.
    settings.inputBegin = lseek(STDIN_FILENO, 0, SEEK_CUR);
    if (access(preload.c_str(), F_OK) != 0) {
        throw InputError("This hashphase has no " +
                         std::filesystem::path(preload).filename().string() +
                         ", because its build found no Bullet of that precision: install that "
                         "Bullet, and build hashphase again.");
    }
    if (!program.sanitizer.empty()) {
        settings.preloads.push_back(program.sanitizer);
    }
    settings.preloads.push_back(preload);
    return settings;
}

// A program that makes none of the broadphases that are taken over runs as ever.
[[noreturn]] void refuse(const TriedProgram& program, const TriedRun& run) {
    const std::string ended = program.path + " " + run.end.text;
    if (!run.isLoaded) {
        throw InputError(ended +
                         ", and did not load hashphase. Setuid programs never do, nor do programs "
                         "that are started without LD_PRELOAD.");
    }
    if (run.end.isCrash) {
        throw InputError(program.path +
                         " had made no btDbvtBroadphase and no axis sweep to compare when it " +
                         run.end.text + ".");
    }
    throw InputError(ended +
                     ", and made no btDbvtBroadphase and no axis sweep that hashphase can replace: "
                     "there is nothing to compare.");
}

std::vector<Broadphase> turnsFor(const TryOptions& options) {
    if (options.verify) {
        return {Broadphase::verifying};
    }
    std::vector<Broadphase> turns;
    for (int i = 0; i < options.runs; ++i) {
        turns.insert(turns.end(), {Broadphase::stock, Broadphase::hash});
    }
    return turns;
}

// Until a signal ends them. Of a run that it ended before there was a broadphase nothing is known.
void runAll(const TryOptions& options, Trial& trial, Console& console) {
    TriedRunSettings settings = settingsFor(options, trial.program, console);
    const std::vector<Broadphase> turns = turnsFor(options);
    for (const Broadphase broadphase : turns) {
        if (isInterrupted()) {
            break;
        }
        settings.broadphase = broadphase;
        if (!options.quiet) {
            console.err << "hashphase try: run " << trial.runs.size() + 1 << " of " << turns.size()
                        << ", with "
                        << (broadphase == Broadphase::stock  ? "Bullet's broadphase"
                            : broadphase == Broadphase::hash ? "hashphase"
                                                             : "both, verified")
                        << std::endl;
        }
        console.out.flush();
        TriedRun run = runTried(settings);
        const bool isEmpty = !run.hasBroadphase();
        if (isEmpty && !isInterrupted() && trial.runs.empty()) {
            refuse(trial.program, run);
        }
        if (!isEmpty || !isInterrupted()) {
            trial.runs.push_back(std::move(run));
        }
        if (isEmpty) {
            break;
        }
    }
}

int runTry(const TryOptions& options, Console& console) {
    if (console.rest.empty()) {
        throw InputError("Name a program to try: hashphase try -- ./program its arguments");
    }
    // Whoever has started us may ignore them, and then none could be waited for.
    std::signal(SIGCHLD, SIG_DFL);
    const std::vector<std::string> bullets =
        bulletsOf({preloadFor("single"), preloadFor("double")});
    if (bullets.empty()) {
        throw InputError("This hashphase has no " + preloadFor("single") +
                         " to load into programs. Builds with a sanitizer have none.");
    }
    Trial trial;
    trial.commandLine = joined(console.rest, " ");
    trial.program = inspectProgram(findProgram(console.rest.front()), bullets, options.precision);
    ResultFile json(options.jsonFile);
    const OtherPrograms others;
    runAll(options, trial, console);
    if (trial.runs.empty()) {
        throw Interrupted();
    }
    trial.provenance = gatherProvenance(console.commandLine);
    trial.provenance.coresOfOthers = others.cores();
    TrialReport report = reportOf(trial);
    printTrial(report, console.out);
    json.write([&](std::ostream& out) { writeTrialJson(report, out); });
    return report.findings.holds == true ? kExitOk : kExitCheckFailed;
}

}  // namespace

Subcommand tryCommand() {
    Subcommand command = makeSubcommand<TryOptions>("try", declare, runTry);
    command.takesRest = true;
    command.nextSignal = NotedSignals::Next::isNoted;
    return command;
}

}  // namespace hashphase::demos
