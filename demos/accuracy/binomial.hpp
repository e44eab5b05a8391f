// SPDX-License-Identifier: Zlib
#pragma once

// How far a share that was counted may lie from the true one.

#include <cstdint>

namespace hashphase::demos {

/// Where the true share lies.
struct ShareInterval {
    double low = 0;
    double high = 1;

    [[nodiscard]] bool contains(double share) const noexcept {
        return low <= share && share <= high;
    }
};

/// The 95 % interval for a share of which `hits` of `trials` were seen, 1 or more trials. Includes 0
/// when there was no hit, and 1 when all were. E. B. Wilson, "Probable Inference, the Law of
/// Succession, and Statistical Inference", 1927.
[[nodiscard]] ShareInterval wilsonInterval(std::uint64_t hits, std::uint64_t trials);

/// The same where the trials are those of several frames in a row, in which the same objects are met
/// again and tell little that is new: as wide as for the trials of one frame.
[[nodiscard]] ShareInterval intervalOverFrames(std::uint64_t hits, std::uint64_t trials,
                                               int frames);

}  // namespace hashphase::demos
