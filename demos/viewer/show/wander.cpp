// SPDX-License-Identifier: Zlib
#include <demos/viewer/show/wander.hpp>

#include <demos/console/format.hpp>
#include <demos/console/progress.hpp>
#include <demos/console/result_file.hpp>
#include <demos/report/stopwatch.hpp>
#include <demos/scenes/file_bytes.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/viewer/draw/draw_error.hpp>
#include <demos/viewer/draw/headless_context.hpp>
#include <demos/viewer/session/script.hpp>
#include <demos/viewer/show/viewer.hpp>
#include <demos/viewer/show/wander_report.hpp>
#include <demos/viewer/show/window.hpp>
#include <demos/viewer/stage/threads.hpp>

#include <algorithm>
#include <charconv>
#include <memory>
#include <ostream>
#include <string>

namespace hashphase::demos {
namespace {

constexpr std::uint64_t kHeadlessFrames = 300;

std::pair<int, int> parseSize(const std::string& text) {
    int width = 0;
    int height = 0;
    const char* const end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, width);
    const bool isPair = first.ec == std::errc() && first.ptr != end && *first.ptr == 'x' &&
                        std::from_chars(first.ptr + 1, end, height).ptr == end;
    if (!isPair || std::min(width, height) < kLeastSide || std::max(width, height) > kMostSide) {
        throw InputError(
            "--size is a width and a height of 16 to 8,192 pixels, as in 1280x800, not '" + text +
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

/// OpenGL without a window, from the first picture on.
class HeadlessViewer {
public:
    void show(Session& session) {
        if (!viewer_) {
            context_ = std::make_unique<HeadlessContext>();
            viewer_ = std::make_unique<Viewer>(session.width(), session.height());
        }
        viewer_->layOut(session);
        viewer_->show(session, {}, 0);
    }

private:
    std::unique_ptr<HeadlessContext> context_;
    std::unique_ptr<Viewer> viewer_;
};

/// What is run and written, whoever shows it.
class Run {
public:
    Run(const WanderOptions& options, Console& console);

    int play();

private:
    void playHeadless();
    void playInWindow();
    [[nodiscard]] std::uint64_t frameCount() const;
    [[nodiscard]] bool isTimeOver();
    [[nodiscard]] bool isHeadlessDone() const;
    [[nodiscard]] bool standsStill() const;
    void feed();
    void tellMessages();
    int end();
    [[nodiscard]] std::string keep(const std::string& fault);
    [[nodiscard]] std::string writeFiles();
    [[nodiscard]] WanderEnd played() const { return {*session_, drewPictures_, framesPerSecond_}; }
    [[nodiscard]] bool isAsExpected() const;

    const WanderOptions& options_;
    Console& console_;
    std::unique_ptr<Session> session_;
    std::optional<Script> script_;
    std::optional<Playback> playback_;
    // Opened before anything runs, but not before what may be read from files of the same name.
    std::optional<ResultFile> record_;
    std::optional<ResultFile> json_;
    bool drewPictures_ = false;
    bool isTimeOver_ = false;
    std::optional<double> framesPerSecond_;  // shown in a window
    Stopwatch watch_;
};

Run::Run(const WanderOptions& options, Console& console) : options_(options), console_(console) {
    if (!options.screenshotFile.empty() && !options.isHeadless) {
        throw InputError("--screenshot is for --headless; in a window press F12.");
    }
    if (!options.replayFile.empty()) {
        playback_.emplace(CommandLog::parse(readText(options.replayFile), options.replayFile));
    }
    if (!options.scriptFile.empty()) {
        script_.emplace(readText(options.scriptFile), options.scriptFile);
    }
    const auto [width, height] = parseSize(options.size);
    {
        const SceneChoice choice = playback_ ? playback_->log().choice() : chosen(options);
        Progress opening(console.err, progressStyle(console, options.quiet),
                         "opening " + titleOf(choice), 1);
        session_ = std::make_unique<Session>(choice, width, height);
    }
    record_.emplace(options.recordFile);
    json_.emplace(options.jsonFile);
    const ResultFile screenshot(options.screenshotFile);  // as a wrong path is to cost no waiting
    session_->options().panel = !options.isHeadless;
    for (const std::string& command : options.commands) {
        session_->run(command);
    }
}

void Run::tellMessages() {
    for (const std::string& message : session_->takeMessages()) {
        console_.out << message << '\n';
    }
}

void Run::feed() {
    if (playback_) {
        playback_->feed(*session_);
    } else if (script_) {
        script_->feed(*session_);
    }
}

// How many are to be simulated without a window.
std::uint64_t Run::frameCount() const {
    return playback_ ? playback_->log().frameCount() : options_.frames.value_or(kHeadlessFrames);
}

bool Run::isTimeOver() {
    isTimeOver_ =
        isTimeOver_ || (options_.timeLimit && watch_.milliseconds() > 1000 * *options_.timeLimit);
    return isTimeOver_;
}

bool Run::standsStill() const {
    return !session_->isPlaying() && !session_->isWaiting();
}

bool Run::isHeadlessDone() const {
    if (session_->isOver()) {
        return true;
    }
    if (session_->wantsScreenshot()) {
        return false;
    }
    if (script_) {
        return script_->isComplete(*session_);
    }
    return (session_->frame() >= frameCount() && !session_->isCapturing()) || standsStill();
}

int Run::play() {
    try {
        if (options_.isHeadless) {
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
    HeadlessViewer viewer;
    Progress progress(console_.err, progressStyle(console_, options_.quiet || script_),
                      titleOf(session_->choice()), frameCount());
    if (script_) {
        session_->setPlaying(false);
    }
    for (feed(); !isHeadlessDone() && !isTimeOver(); feed()) {
        session_->advance();
        if (session_->wantsScreenshot()) {
            drewPictures_ = true;
            viewer.show(*session_);
        }
        tellMessages();
        progress.update(std::min(session_->frame(), frameCount()));
    }
    progress.clear();
    if (!script_ && !session_->isOver() && standsStill() && session_->frame() < frameCount()) {
        console_.err << "hashphase: the scene stands still after "
                     << withThousands(session_->frame()) << " of " << withThousands(frameCount())
                     << " frames, because a command has paused it.\n";
    }
    if (!options_.screenshotFile.empty()) {
        session_->askForScreenshot(options_.screenshotFile);
        viewer.show(*session_);
    }
}

void Run::playInWindow() {
    Window window(session_->width(), session_->height());
    if (playback_) {
        window.setGuard(Playback::refuseChange);
    }
    drewPictures_ = true;
    const FrameRate rate = window.run(*session_, options_.frames.value_or(0), [this] {
        feed();
        return isTimeOver() || (playback_ && playback_->isDone(*session_));
    });
    framesPerSecond_ = rate.perSecond();
}

int Run::end() {
    session_->endCapture("the run ends");
    tellMessages();
    if (!playback_ && !script_) {
        tellPhases(played(), console_.out);
    }
    tellFrameRate(played(), console_.out);
    if (const std::string faults = writeFiles(); !faults.empty()) {
        throw InputError(faults);
    }
    return isAsExpected() ? kExitOk : kExitCheckFailed;
}

// What was played until a fault is not lost. Returns that fault, and what cannot be written besides.
std::string Run::keep(const std::string& fault) {
    if (session_->frame() == 0) {
        return fault;
    }
    session_->endCapture("the run ends");
    tellMessages();
    const std::string others = writeFiles();
    return others.empty() ? fault : fault + " " + others;
}

// Each that can be written; returns what is to be said of the others.
std::string Run::writeFiles() {
    std::string faults;
    const auto write = [&faults](ResultFile& file, const auto& content) {
        try {
            file.write(content);
        } catch (const InputError& fault) {
            faults += (faults.empty() ? "" : " ") + std::string(fault.what());
        }
    };
    write(*record_, [this](std::ostream& out) { out << session_->log().text(); });
    write(*json_, [this](std::ostream& out) { writeNumbers(played(), out); });
    return faults;
}

// Says so, too. Who ends a script or a replay early wants no more of it; a time limit cuts it off.
bool Run::isAsExpected() const {
    bool isSame = true;
    bool isComplete = true;
    if (playback_) {
        console_.out << playback_->verdict(*session_, isSame) << '\n';
        isComplete = playback_->isDone(*session_);
    }
    if (script_) {
        if (const std::string verdict = script_->verdict(*session_); !verdict.empty()) {
            console_.out << verdict << '\n';
        }
        isComplete = script_->isComplete(*session_);
    }
    return isSame && session_->failureCount() == 0 && (isComplete || !isTimeOver_);
}

}  // namespace

int runWander(const WanderOptions& options, Console& console) {
    if (options.list) {
        listWander(console.out);
        return kExitOk;
    }
    const ThreadLimit threads(options.threads.value_or(threadCount()));
    return Run(options, console).play();
}

}  // namespace hashphase::demos
