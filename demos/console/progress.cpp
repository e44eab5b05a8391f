// SPDX-License-Identifier: Zlib
#include <demos/console/progress.hpp>

#include <demos/console/format.hpp>

#include <algorithm>
#include <ostream>
#include <utility>

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

Progress::Progress(std::ostream& out, ProgressStyle style, std::string task, std::size_t total)
    : out_(out), style_(style), task_(std::move(task)), total_(std::max<std::size_t>(total, 1)) {
    if (style_ == ProgressStyle::kBar) {
        drawBar(0, task_);
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
    const Clock::time_point now = Clock::now();
    const auto interval = style_ == ProgressStyle::kBar ? kBarInterval : kLineInterval;
    if (style_ == ProgressStyle::kSilent || now - lastDrawn_ < interval) {
        return;
    }
    lastDrawn_ = now;
    std::string line = task_ + ": ";
    line += what.empty() ? withThousands(done) + " of " + withThousands(total_) : std::string(what);
    if (done > 0) {
        const double elapsed = std::chrono::duration<double>(now - start_).count();
        const double left = elapsed * static_cast<double>(total_ - std::min(done, total_)) /
                            static_cast<double>(done);
        line += ", " + fixed(left, left < 10 ? 1 : 0) + " s to go";
    }
    if (style_ == ProgressStyle::kBar) {
        drawBar(done, line);
    } else if (done < total_) {
        out_ << line << std::endl;
    }
}

void Progress::drawBar(std::size_t done, const std::string& line) {
    const std::size_t filled = std::min(done, total_) * kBarWidth / total_;
    const std::string bar =
        '[' + std::string(filled, '#') + std::string(kBarWidth - filled, '.') + "] " + line;
    // Blanks wipe what a longer line before left behind.
    out_ << '\r' << bar << std::string(drawnWidth_ - std::min(drawnWidth_, bar.size()), ' ')
         << std::flush;
    drawnWidth_ = bar.size();
}

}  // namespace hashphase::demos
