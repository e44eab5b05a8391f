// SPDX-License-Identifier: Zlib
#include <demos/viewer/show/wander.hpp>

#include <demos/console/format.hpp>
#include <demos/console/options.hpp>
#include <demos/console/progress.hpp>
#include <demos/console/result_file.hpp>
#include <demos/report/report_text.hpp>
#include <demos/report/time_limit.hpp>
#include <demos/scenes/file_bytes.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/viewer/draw/headless_context.hpp>
#include <demos/viewer/session/script.hpp>
#include <demos/viewer/show/viewer.hpp>
#include <demos/viewer/show/window.hpp>
#include <demos/viewer/stage/paper_stage.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <memory>
#include <ostream>
#include <string>

namespace hashphase::demos {
namespace {

constexpr std::uint64_t kHeadlessFrames = 300;

struct WanderOptions {
    SceneChoice scene;                  // its seed is its own, unless there is one here:
    std::optional<std::uint64_t> seed;  // that was asked for
    std::string size = "1280x800";      // of the picture or window [pixels]
    bool isHeadless = false;
    std::vector<std::string> commands;    // run at the start
    std::string scriptFile;               // run then
    std::string replayFile;               // instead of a scene
    std::string recordFile;               // written at the end; empty: none
    std::string screenshotFile;           // the same
    std::string jsonFile;                 // the same
    std::optional<std::uint64_t> frames;  // to be simulated
    std::optional<double> timeLimit;      // [s]
    std::optional<std::size_t> threads;   // at most; all that there are otherwise
    bool quiet = false;
    bool list = false;
};

/// What is shown, and at its beginning; what is done with it, and for how long; and what is said and written.
void declareWander(CLI::App& app, WanderOptions& options) {
    CLI::Option* scene = app.add_option("--scene", options.scene.name, "scene; --list prints all")
                             ->type_name("NAME")
                             ->capture_default_str();
    CLI::Option* file =
        addFileToRead(
            app, "--file", options.scene.file,
            "read this file instead: a scene file (.json), or a recording of boxes (.aabbs)")
            ->excludes(scene);
    CLI::Option* objects = app.add_option("--objects", options.scene.objects,
                                          "number of bodies (default: the scene's own)");
    objects->transform(wholeFrom(1, kMostObjects));
    CLI::Option* seed = app.add_option("--seed", options.seed,
                                       "seed of the scene (default: 1, or the scene file's own)");
    seed->transform(seedUpTo(kMostSeed));
    CLI::Option* commands = app.add_option(
        "--do", options.commands,
        "run this command (in quotes) at the start; repeat the option for more commands");
    commands->type_name("COMMAND")->allow_extra_args(false);
    CLI::Option* script = addFileToRead(app, "--script", options.scriptFile,
                                        "run the commands of this file, after those of --do");
    CLI::Option* replay = addFileToRead(app, "--replay", options.replayFile,
                                        "play back this recording, and compare the results; in a "
                                        "window you can pause (P), step (O) and restart (R) it, "
                                        "and change nothing");
    for (CLI::Option* other : {script, scene, file, objects, seed, commands}) {
        replay->excludes(other);
    }
    app.add_option("--frames", options.frames,
                   "number of frames (default: until you close the window; without a window 300, "
                   "or until a command pauses the simulation)")
        ->transform(wholeFrom(1, 1'000'000'000))
        ->excludes(script)
        ->excludes(replay);
    app.add_option("--time-limit", options.timeLimit,
                   "stop after this many seconds; a script or replay that is not complete then "
                   "counts as failed")
        ->transform(positiveSeconds());
    app.add_option("--threads", options.threads,
                   "maximum number of threads (default: all; scenes with Bullet dynamics use one)")
        ->transform(wholeFrom(1, 1024));
    app.add_option("--size", options.size, "size of the picture in pixels, up to 8,192 each way")
        ->type_name("WIDTHxHEIGHT")
        ->capture_default_str();
    app.add_flag("--headless", options.isHeadless, "open no window; draw only for screenshots");
    addFileToWrite(app, "--record", options.recordFile,
                   "write a recording to this file at the end");
    addFileToWrite(app, "--screenshot", options.screenshotFile,
                   "write a picture (PNG) to this file at the end");
    addFileToWrite(app, "--json", options.jsonFile, "write all numbers to this file at the end");
    app.add_flag("--quiet", options.quiet, "print no progress");
    app.add_flag("--list", options.list,
                 "print the scenes, keys, commands, effects and readings, and exit");
}

// --- A run ---------------------------------------------------------------------------------------

std::pair<int, int> parseSize(const std::string& text) {
    int width = 0;
    int height = 0;
    const char* const end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, width);
    const bool isPair = first.ec == std::errc() && first.ptr != end && *first.ptr == 'x' &&
                        std::from_chars(first.ptr + 1, end, height).ptr == end;
    if (!isPair || std::min(width, height) < kLeastSide || std::max(width, height) > kMostSide) {
        throw InputError(
            "--size is a width and a height of 16 to 8,192 pixels, like 1280x800, not '" + text +
            "'.");
    }
    return {width, height};
}

SceneChoice chosen(const WanderOptions& options) {
    SceneChoice choice = options.scene;
    if (options.seed && isBoxRecording(choice)) {
        throw InputError("--seed is for scenes; " + choice.file + " is a recording of boxes.");
    }
    choice.seed = options.seed ? *options.seed : ownSeed(choice);
    return choice;
}

/// OpenGL without a window.
struct HeadlessViewer {
    HeadlessContext context;
    Viewer viewer;
};

/// What is run and written, whoever shows it.
struct Run {
    Run(const WanderOptions& given, Console& said);

    int play();
    void playHeadless();
    void playInWindow();
    void feed();
    void tellMessages();
    int end();
    [[nodiscard]] bool isTimeOver();
    [[nodiscard]] bool isHeadlessDone() const;
    [[nodiscard]] bool standsStill() const { return !session->isPlaying && !session->isWaiting(); }
    [[nodiscard]] std::string keep(const std::string& fault);
    [[nodiscard]] std::string writeFiles();
    [[nodiscard]] bool isAsExpected() const;
    /// How many are to be simulated without a window.
    [[nodiscard]] std::uint64_t frameCount() const {
        return playback ? playback->log().frames : options.frames.value_or(kHeadlessFrames);
    }

    const WanderOptions& options;
    Console& console;
    std::unique_ptr<Session> session;
    std::optional<Script> script;
    std::optional<Playback> playback;
    // Opened before anything runs, as a wrong path is to cost no waiting, but not before what may be read from files
    // of the same name; and opened again to be written, as commands may have written to the same files.
    std::optional<ResultFile> record;
    std::optional<ResultFile> json;
    bool drewPictures = false;
    bool timeIsOver = false;
    std::optional<double> framesPerSecond;  // shown in a window
    TimeLimit limit{options.timeLimit};
};

Run::Run(const WanderOptions& given, Console& said) : options(given), console(said) {
    if (!options.screenshotFile.empty() && !options.isHeadless) {
        throw InputError("--screenshot is for --headless; in a window press F12.");
    }
    if (!options.replayFile.empty()) {
        playback.emplace(CommandLog::parse(readText(options.replayFile), options.replayFile));
    }
    if (!options.scriptFile.empty()) {
        script.emplace(readText(options.scriptFile), options.scriptFile);
    }
    const auto [width, height] = parseSize(options.size);
    {
        const SceneChoice choice = playback ? playback->log().choice : chosen(options);
        Progress opening(console.err, progressStyle(console, options.quiet),
                         "opening " + titleOf(choice), 1);
        session = std::make_unique<Session>(choice, width, height);
    }
    record.emplace(options.recordFile);
    json.emplace(options.jsonFile);
    const ResultFile screenshot(options.screenshotFile);  // as a wrong path is to cost no waiting
    session->options.panel = !options.isHeadless;
    for (const std::string& command : options.commands) {
        session->run(command);
    }
}

void Run::tellMessages() {
    for (const std::string& message : session->takeMessages()) {
        console.out << message << '\n';
    }
}

void Run::feed() {
    if (playback) {
        playback->feed(*session);
    } else if (script) {
        script->feed(*session);
    }
}

bool Run::isTimeOver() {
    timeIsOver = timeIsOver || limit.isOver();
    return timeIsOver;
}

bool Run::isHeadlessDone() const {
    if (session->isOver) {
        return true;
    }
    if (!session->screenshots.empty()) {
        return false;
    }
    if (script) {
        return script->isComplete(*session);
    }
    return (session->frame >= frameCount() && !session->recorder) || standsStill();
}

int Run::play() {
    try {
        if (options.isHeadless) {
            playHeadless();
        } else {
            playInWindow();
        }
    } catch (const InputError& fault) {
        throw InputError(keep(fault.what()));
    } catch (const DrawError& fault) {
        throw InputError(keep(fault.what()));
    }
    return end();
}

void Run::playHeadless() {
    std::unique_ptr<HeadlessViewer> pictures;  // from the first one on
    const auto show = [&] {
        if (pictures == nullptr) {
            pictures.reset(new HeadlessViewer{{}, {session->width, session->height}});
        }
        pictures->viewer.layOut(*session);
        pictures->viewer.show(*session, {}, 0);
    };
    Progress progress(console.err, progressStyle(console, options.quiet || script),
                      titleOf(session->choice), frameCount());
    if (script) {
        session->isPlaying = false;
    }
    for (feed(); !isHeadlessDone() && !isTimeOver(); feed()) {
        session->advance();
        if (!session->screenshots.empty()) {
            drewPictures = true;
            show();
        }
        tellMessages();
        progress.update(std::min(session->frame, frameCount()));
    }
    progress.clear();
    if (!script && !session->isOver && standsStill() && session->frame < frameCount()) {
        console.err << "hashphase: a command paused the scene after "
                    << withThousands(session->frame) << " of " << withThousands(frameCount())
                    << " frames.\n";
    }
    if (!options.screenshotFile.empty()) {
        session->askForScreenshot(options.screenshotFile);
        show();
    }
}

void Run::playInWindow() {
    drewPictures = true;
    const FrameRate rate = showInWindow(
        *session, options.frames.value_or(0),
        [this] {
            feed();
            return isTimeOver() || (playback && playback->isDone(*session));
        },
        playback ? Playback::refuseChange : nullptr);
    framesPerSecond = rate.perSecond();
}

int Run::end() {
    session->endCapture("the run ends");
    tellMessages();
    if (!playback && !script) {
        tellPhases(*session, drewPictures, console.out);
    }
    if (framesPerSecond) {
        console.out << fixed(*framesPerSecond, 1)
                    << " frames shown per second, without the first second\n";
    }
    if (const std::string interruption = interruptionText(); !interruption.empty()) {
        console.out << interruption << '\n';
    }
    if (const std::string faults = writeFiles(); !faults.empty()) {
        throw InputError(faults);
    }
    return isAsExpected() ? kExitOk : kExitCheckFailed;
}

// What was played until a fault is not lost. Returns that fault, and what cannot be written besides.
std::string Run::keep(const std::string& fault) {
    if (session->frame == 0) {
        return fault;
    }
    session->endCapture("the run ends");
    tellMessages();
    const std::string others = writeFiles();
    return others.empty() ? fault : fault + " " + others;
}

// Each that can be written; returns what is to be said of the others.
std::string Run::writeFiles() {
    ResultFaults faults;
    const auto write = [&faults](std::optional<ResultFile>& file, const std::string& path,
                                 const auto& content) {
        faults.collect([&] {
            std::error_code unknown;
            if (!std::filesystem::is_fifo(path, unknown)) {  // its reader takes a close as the end
                file.emplace(path);
            }
            file->write(content);
        });
    };
    write(record, options.recordFile, [this](std::ostream& out) { out << session->log.text(); });
    write(json, options.jsonFile,
          [this](std::ostream& out) { writeNumbers(*session, framesPerSecond, out); });
    return faults.text();
}

// Says so, too. Who ends a script or a replay early wants no more of it; a time limit cuts it off.
bool Run::isAsExpected() const {
    bool isSame = true;
    bool isComplete = true;
    if (playback) {
        console.out << playback->verdict(*session, isSame) << '\n';
        isComplete = playback->isDone(*session);
    }
    if (script) {
        if (const std::string verdict = script->verdict(*session); !verdict.empty()) {
            console.out << verdict << '\n';
        }
        isComplete = script->isComplete(*session);
    }
    return isSame && session->failureCount == 0 && (isComplete || !timeIsOver);
}

}  // namespace

Subcommand wanderCommand() {
    return makeSubcommand<WanderOptions>(
        "wander", declareWander, [](const auto& options, Console& console) {
            if (options.list) {
                listWander(console.out);
                return int{kExitOk};
            }
            const auto threads = options.threads ? limitThreads(*options.threads) : nullptr;
            return Run(options, console).play();
        });
}

}  // namespace hashphase::demos
