// SPDX-License-Identifier: Zlib
#include <demos/console/progress.hpp>

#include <demos/console/columns.hpp>
#include <demos/console/format.hpp>

#include <algorithm>
#include <ostream>

namespace hashphase::demos {
namespace {

constexpr std::chrono::milliseconds kBarInterval{100};
constexpr std::chrono::milliseconds kLineInterval{5'000};
constexpr std::size_t kBarWidth = 30;

}  // namespace

ProgressStyle progressStyle(const Console& console, bool quiet) {
    if (quiet) {
        return ProgressStyle::kSilent;
    }
    return console.errIsTerminal ? ProgressStyle::kBar : ProgressStyle::kLines;
}

std::optional<double> secondsToGo(double elapsed, double share) noexcept {
    constexpr double kFewestSeconds = 2;
    constexpr double kLeastShare = 0.03;
    return elapsed < kFewestSeconds || share < kLeastShare
               ? std::nullopt
               : std::optional(elapsed * (1 - share) / share);
}

Progress::Progress(std::ostream& out, ProgressStyle style, const std::string& task,
                   std::size_t total, ProgressSurroundings surroundings)
    : out_(out),
      style_(style),
      task_(masked(task)),
      total_(std::max<std::size_t>(total, 1)),
      surroundings_(surroundings),
      lastDrawn_(surroundings_.now()) {
    if (style_ == ProgressStyle::kBar) {
        drawBar(0, task_, "");
        lastDrawn_ -= kBarInterval;  // the first step may take long
    }
}

void Progress::clear() {
    if (drawnWidth_ > 0) {
        out_ << '\r' << std::string(drawnWidth_, ' ') << '\r' << std::flush;
        drawnWidth_ = 0;
    }
}

void Progress::update(std::size_t done, std::string_view what) {
    const Clock::time_point now = surroundings_.now();
    if (!firstUpdate_) {
        firstUpdate_ = now;
        doneBefore_ = std::min(done, total_ - 1);
    }
    const auto interval = style_ == ProgressStyle::kBar ? kBarInterval : kLineInterval;
    if (style_ == ProgressStyle::kSilent || now - lastDrawn_ < interval) {
        return;
    }
    lastDrawn_ = now;
    std::string text = task_ + ": ";
    text += what.empty() ? withThousands(done) + " of " + withThousands(total_) : std::string(what);
    if (style_ == ProgressStyle::kBar) {
        drawBar(done, text, toGoText(done, now));
    } else if (done < total_) {
        out_ << text << toGoText(done, now) << std::endl;
    }
}

std::string Progress::toGoText(std::size_t done, Clock::time_point now) const {
    const auto stepsSince =
        static_cast<double>(std::clamp(done, doneBefore_, total_) - doneBefore_);
    const std::optional<double> left =
        secondsToGo(std::chrono::duration<double>(now - *firstUpdate_).count(),
                    stepsSince / static_cast<double>(total_ - doneBefore_));
    return left ? ", " + fixed(*left, *left < 10 ? 1 : 0) + " s to go" : "";
}

// In a line: the text is clipped, and the time that is left stays.
void Progress::drawBar(std::size_t done, const std::string& text, const std::string& toGo) {
    const std::size_t columns = surroundings_.columns();
    const std::size_t room =
        (columns > 0 ? columns : kUsualColumns) - 1;  // terminals may break a full line
    const std::size_t filled = std::min(done, total_) * kBarWidth / total_;
    const std::string bar =
        '[' + std::string(filled, '#') + std::string(kBarWidth - filled, '.') + "] ";
    const std::size_t taken = bar.size() + toGo.size();
    const std::string line =
        clipped(bar + clipped(text, room - std::min(room, taken)) + toGo, room);
    const std::size_t width = columnsOf(line);
    // Blanks wipe what a longer line before left behind.
    const std::size_t wiped = std::min(drawnWidth_, room);
    out_ << '\r' << line << std::string(wiped - std::min(wiped, width), ' ') << std::flush;
    drawnWidth_ = width;
}

}  // namespace hashphase::demos
