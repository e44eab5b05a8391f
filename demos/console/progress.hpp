// SPDX-License-Identifier: Zlib
#pragma once

// How far a long task is, and how long it will still take.

#include <demos/console/program.hpp>
#include <demos/system/process.hpp>

#include <chrono>
#include <cstddef>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>

namespace hashphase::demos {

enum class ProgressStyle {
    kSilent,
    kBar,    // a bar that redraws itself, for terminals
    kLines,  // a line every few seconds, for logs
};

/// A bar where errors go to a terminal, lines elsewhere.
[[nodiscard]] ProgressStyle progressStyle(const Console& console, bool quiet);

/// An estimate of the seconds that are left, from the share that is done after so many seconds. Nothing in the
/// first 2 s, and before 3 % are done.
[[nodiscard]] std::optional<double> secondsToGo(double elapsed, double share) noexcept;

/// What a progress asks of the machine.
struct ProgressSurroundings {
    std::size_t (*columns)() = errColumns;  // of the terminal
    std::chrono::steady_clock::time_point (*now)() = std::chrono::steady_clock::now;
};

class Progress {
public:
    /// Tells `out` about `total` steps of the task; a bar is drawn at once.
    Progress(std::ostream& out, ProgressStyle style, const std::string& task, std::size_t total,
             ProgressSurroundings surroundings = {});
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Wipes the bar.
    ~Progress() { clear(); }

    /// Wipes the bar until the next update, so that something else can be written.
    void clear();

    /// Says that `done` steps are done; draws at most a few times a second. Where steps mean nothing
    /// to a reader, `what` says in their place what is being done. The time that is left is estimated from the first
    /// update on: what comes before it is preparation.
    void update(std::size_t done, std::string_view what = {});

private:
    using Clock = std::chrono::steady_clock;

    void drawBar(std::size_t done, const std::string& text, const std::string& toGo);
    [[nodiscard]] std::string toGoText(std::size_t done, Clock::time_point now) const;

    std::ostream& out_;
    ProgressStyle style_;
    std::string task_;
    std::size_t total_;
    ProgressSurroundings surroundings_;
    Clock::time_point lastDrawn_;
    std::optional<Clock::time_point> firstUpdate_;
    std::size_t doneBefore_ = 0;  // by then
    std::size_t drawnWidth_ = 0;  // [columns]
};

}  // namespace hashphase::demos
