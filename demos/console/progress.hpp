// SPDX-License-Identifier: Zlib
#pragma once

// How far a long task is, and how long it will still take.

#include <demos/console/program.hpp>

#include <chrono>
#include <cstddef>
#include <iosfwd>
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

class Progress {
public:
    /// Tells `out` about `total` steps of the task; a bar is drawn at once.
    Progress(std::ostream& out, ProgressStyle style, std::string task, std::size_t total);
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Wipes the bar.
    ~Progress() { clear(); }

    /// Wipes the bar until the next update, so that something else can be written.
    void clear();

    /// Says that `done` steps are done; draws at most a few times a second. Where steps mean nothing
    /// to a reader, `what` says in their place what is being done.
    void update(std::size_t done, std::string_view what = {});

private:
    void drawBar(std::size_t done, const std::string& line);

    using Clock = std::chrono::steady_clock;

    std::ostream& out_;
    ProgressStyle style_;
    std::string task_;
    std::size_t total_;
    Clock::time_point start_ = Clock::now();
    Clock::time_point lastDrawn_ = start_;
    std::size_t drawnWidth_ = 0;
};

}  // namespace hashphase::demos
