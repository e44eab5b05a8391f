// SPDX-License-Identifier: Zlib
#pragma once

#include <cstdint>
#include <optional>

namespace hashphase::demos {

/// How many frames a window has shown in a second. The first second is left out: windows and tables come up
/// in it.
class FrameRate {
public:
    /// A frame has been shown, so many seconds after the window came up.
    void note(double seconds) {
        if (seconds < kLeftOut) {
            return;
        }
        if (!begin_) {
            begin_ = seconds;
        } else {
            ++frameCount_;
            end_ = seconds;
        }
    }

    /// None where nothing was shown after the first second.
    [[nodiscard]] std::optional<double> perSecond() const {
        if (frameCount_ == 0 || !(end_ > *begin_)) {
            return std::nullopt;
        }
        return static_cast<double>(frameCount_) / (end_ - *begin_);
    }

private:
    static constexpr double kLeftOut = 1;  // [s]

    std::optional<double> begin_;  // when the last frame was shown that is left out [s]
    double end_ = 0;               // when the last one was [s]
    std::uint64_t frameCount_ = 0;
};

}  // namespace hashphase::demos
