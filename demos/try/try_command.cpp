// SPDX-License-Identifier: Zlib
#include <demos/try/try_command.hpp>

#include <demos/console/format.hpp>
#include <demos/console/options.hpp>
#include <demos/console/result_file.hpp>
#include <demos/console/subcommands.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/try/try_report.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <memory>
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
    std::vector<std::string> words;  // the program and its arguments
    bool verify = false;
    std::optional<BulletPrecision> precision;
    std::optional<std::uint32_t> steps;
    std::optional<double> seconds;
    int runs = 1;
    std::string jsonFile;
    bool quiet = false;
};

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

// --- What is tried -------------------------------------------------------------------------------

// Where the libraries are when this is installed, and when it is built.
std::filesystem::path preloadFolder() {
    std::error_code error;
    const std::filesystem::path here =
        std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
    const std::filesystem::path installed = here / HASHPHASE_PRELOAD_FROM_PROGRAM;
    return std::filesystem::is_directory(installed, error) ? installed : here;
}

std::string preloadFor(BulletPrecision precision) {
    const char* name = precision == BulletPrecision::kSingle ? "libhashphase-try.so"
                                                             : "libhashphase-try-float64.so";
    return std::filesystem::weakly_canonical(preloadFolder() / name).string();
}

bool exists(const std::string& path) {
    std::error_code error;
    return std::filesystem::exists(path, error);
}

// The Bullets that the libraries link, by name.
std::vector<std::string> ownBullets() {
    const std::string loader = loaderOf("/proc/self/exe");
    std::vector<std::string> names;
    for (const BulletPrecision precision : {BulletPrecision::kSingle, BulletPrecision::kDouble}) {
        const std::string preload = preloadFor(precision);
        if (!exists(preload)) {
            continue;
        }
        for (const SharedLibrary& library : sharedLibrariesOf(preload, loader)) {
            if (library.name.starts_with("libBulletCollision")) {
                names.push_back(library.name);
            }
        }
    }
    return names;
}

TriedRunSettings settingsFor(const TryOptions& options, const TriedProgram& program) {
    TriedRunSettings settings;
    settings.path = program.path;
    settings.words = options.words;
    const std::string preload = preloadFor(program.precision);
    settings.stepLimit = options.steps;
    settings.secondLimit = options.seconds;
    // A script may have read some of it, and go on behind us.
    settings.inputBegin = lseek(STDIN_FILENO, 0, SEEK_CUR);
    if (!exists(preload)) {
        throw InputError("this hashphase was built without " +
                         std::filesystem::path(preload).filename().string() +
                         ": Bullet of that precision was not found when it was");
    }
    if (!program.sanitizer.empty()) {
        settings.preloads.push_back(program.sanitizer);
    }
    settings.preloads.push_back(preload);
    return settings;
}

std::string nameOf(Broadphase broadphase) {
    return broadphase == Broadphase::stock  ? "Bullet's broadphase"
           : broadphase == Broadphase::hash ? "hashphase"
                                            : "both, verified";
}

void sayWhatRuns(const TryOptions& options, Broadphase broadphase, std::size_t number,
                 std::size_t count, Console& console) {
    if (!options.quiet) {
        console.err << "hashphase try: run " << number << " of " << count << ", with "
                    << nameOf(broadphase) << std::endl;
    }
}

// A program that makes none of the broadphases that are taken over runs as ever.
[[noreturn]] void refuse(const Trial& trial, const TriedRun& run) {
    if (run.isLoaded && run.end.isCrash) {
        throw InputError(trial.program.path +
                         " had made no btDbvtBroadphase and no axis sweep, and so nothing to "
                         "compare, when it " +
                         textOf(run.end));
    }
    if (!run.isLoaded) {
        throw InputError(trial.program.path + " " + textOf(run.end) +
                         ", and has not loaded what was preloaded: programs with rights of their "
                         "own (setuid) do not, nor those that are started without LD_PRELOAD");
    }
    throw InputError(trial.program.path + " " + textOf(run.end) +
                     ", and has made no btDbvtBroadphase and no axis sweep that can be taken over: "
                     "there is nothing to compare");
}

bool isSound(const Trial& trial) {
    const bool isCompared =
        trial.runs.front().broadphase == Broadphase::verifying || compareSteps(trial).has_value();
    return isCompared && !isEndOfOurs(trial) &&
           std::all_of(trial.runs.begin(), trial.runs.end(), [](const TriedRun& run) {
               return run.hasBroadphase && run.verification.missing == 0 &&
                      run.verification.extra == 0 &&
                      (run.broadphase != Broadphase::verifying ||
                       (run.verification.calculations > 0 && !run.end.isCrash));
           });
}

// Until a signal ends them: returns it, or 0. Of a run that it ended before there was a broadphase nothing is
// known.
int runAll(const TryOptions& options, const std::vector<Broadphase>& turns, Trial& trial,
           Console& console) {
    TriedRunSettings settings = settingsFor(options, trial.program);
    settings.sayThatItWaits = [&] {
        console.err << "hashphase try: the program has ended, and has left others running; waiting "
                       "for these (Ctrl-C ends them)"
                    << std::endl;
    };
    const NotedSignals signals;
    for (const Broadphase broadphase : turns) {
        settings.broadphase = broadphase;
        sayWhatRuns(options, broadphase, trial.runs.size() + 1, turns.size(), console);
        console.out.flush();
        TriedRun run = runTried(settings, signals);
        const bool isEmpty = !run.hasBroadphase;
        if (isEmpty && signals.received() == 0 && trial.runs.empty()) {
            refuse(trial, run);
        }
        if (!isEmpty || signals.received() == 0) {
            trial.runs.push_back(std::move(run));
        }
        if (isEmpty || signals.received() != 0) {
            break;
        }
    }
    return signals.received();
}

int runTry(const TryOptions& options, Console& console) {
    if (options.words.empty()) {
        throw InputError("name a program to try: hashphase try -- ./program its arguments");
    }
    // Whoever has started us may ignore them, and then none could be waited for.
    std::signal(SIGCHLD, SIG_DFL);
    Trial trial;
    trial.commandLine = joined(options.words, " ");
    const std::vector<std::string> bullets = ownBullets();
    if (bullets.empty()) {
        throw InputError("this hashphase has no " + preloadFor(BulletPrecision::kSingle) +
                         " to load into programs, as builds under a sanitizer have not");
    }
    trial.program = inspectProgram(findProgram(options.words.front()), bullets, options.precision);
    ResultFile json(options.jsonFile);

    std::vector<Broadphase> turns{Broadphase::verifying};
    if (!options.verify) {
        turns.clear();
        for (int i = 0; i < options.runs; ++i) {
            turns.insert(turns.end(), {Broadphase::stock, Broadphase::hash});
        }
    }
    const int interruption = runAll(options, turns, trial, console);
    constexpr int kExitInterrupted = 128;  // and the signal, as shells have it
    if (trial.runs.empty()) {
        return kExitInterrupted + interruption;
    }
    trial.provenance = gatherProvenance(console.commandLine);
    printTrial(trial, console.out);
    json.write([&](std::ostream& out) { writeTrialJson(trial, out); });
    if (interruption != 0) {
        return kExitInterrupted + interruption;
    }
    return isSound(trial) ? kExitOk : kExitCheckFailed;
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
