// SPDX-License-Identifier: Zlib
#include <demos/try/try.hpp>

#include <demos/console/result_file.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/try/try_report.hpp>

#include <algorithm>
#include <array>
#include <filesystem>
#include <ostream>
#include <system_error>

#include <unistd.h>

namespace hashphase::demos {
namespace {

using tryout::Broadphase;

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
    settings.preload = preloadFor(program.precision);
    settings.stepLimit = options.steps;
    settings.secondLimit = options.seconds;
    // A script may have read some of it, and go on behind us.
    settings.inputBegin = lseek(STDIN_FILENO, 0, SEEK_CUR);
    if (!exists(settings.preload)) {
        throw InputError("this hashphase was built without " +
                         std::filesystem::path(settings.preload).filename().string() +
                         ": Bullet of that precision was not found when it was");
    }
    if (!program.sanitizer.empty()) {
        settings.preload = program.sanitizer + ":" + settings.preload;
    }
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
    throw InputError(trial.program.path + " " + textOf(run.end) +
                     ", and has made no btDbvtBroadphase and no axis sweep that can be taken over: "
                     "there is nothing to compare");
}

bool isSound(const Trial& trial) {
    return !isEndOfOurs(trial) &&
           std::all_of(trial.runs.begin(), trial.runs.end(), [](const TriedRun& run) {
               return run.missing == 0 && run.extra == 0 &&
                      (run.broadphase != Broadphase::verifying || run.calculations > 0);
           });
}

}  // namespace

int runTry(const TryOptions& options, Console& console) {
    if (options.words.empty()) {
        throw InputError("name a program to try: hashphase try -- ./program its arguments");
    }
    ResultFile json(options.jsonFile);
    Trial trial;
    for (const std::string& word : options.words) {
        trial.commandLine += (trial.commandLine.empty() ? "" : " ") + word;
    }
    const std::vector<std::string> bullets = ownBullets();
    if (bullets.empty()) {
        throw InputError("this hashphase has no " + preloadFor(BulletPrecision::kSingle) +
                         " to load into programs, as builds under a sanitizer have not");
    }
    trial.program = inspectProgram(findProgram(options.words.front()), bullets, options.precision);
    TriedRunSettings settings = settingsFor(options, trial.program);

    std::vector<Broadphase> turns{Broadphase::verifying};
    if (!options.verify) {
        turns.clear();
        for (int i = 0; i < options.runs; ++i) {
            turns.insert(turns.end(), {Broadphase::stock, Broadphase::hash});
        }
    }
    int interruption = 0;
    for (const Broadphase broadphase : turns) {
        settings.broadphase = broadphase;
        sayWhatRuns(options, broadphase, trial.runs.size() + 1, turns.size(), console);
        console.out.flush();
        trial.runs.push_back(runTried(settings));
        interruption = trial.runs.back().interruption;
        if (!trial.runs.back().hasBroadphase) {
            refuse(trial, trial.runs.back());
        }
        if (interruption != 0) {
            break;
        }
    }
    printTrial(trial, console.out);
    json.write([&](std::ostream& out) { writeTrialJson(trial, console.commandLine, out); });
    constexpr int kExitInterrupted = 128;  // and the signal, as shells have it
    if (interruption != 0) {
        return kExitInterrupted + interruption;
    }
    return isSound(trial) ? kExitOk : kExitCheckFailed;
}

}  // namespace hashphase::demos
