// SPDX-License-Identifier: Zlib
#pragma once

// What ways to know contacts get wrong, counted over frames.

#include <demos/accuracy/binomial.hpp>
#include <demos/accuracy/sweeps/sweep_truth.hpp>

#include <memory>
#include <span>
#include <vector>

namespace hashphase::demos {

/// Sums over frames. Contacts are those that begin during a frame.
struct SweepTally {
    std::uint64_t frames = 0;
    std::uint64_t movers = 0;
    std::uint64_t contacts = 0;
    std::uint64_t missed = 0;
    std::uint64_t invented = 0;      // listed, but not touching at any time
    std::uint64_t framesUnlike = 0;  // of exact methods: other pairs than the first of them lists
    std::uint64_t timesAsked = 0;
    double worstTimeError = 0;          // [shares of the frame]
    double worstRelativeTimeError = 0;  // infinite when no time was given
    std::optional<SweepWork> work;

    SweepTally& operator+=(const SweepTally& more);

    [[nodiscard]] std::uint64_t detected() const noexcept { return contacts - missed; }
    [[nodiscard]] double missedShare() const noexcept {
        return contacts == 0 ? 0 : static_cast<double>(missed) / static_cast<double>(contacts);
    }
    [[nodiscard]] double perMover(std::uint64_t count) const noexcept {
        return movers == 0 ? 0 : static_cast<double>(count) / static_cast<double>(movers);
    }
    [[nodiscard]] ShareInterval missedInterval() const {
        return contacts == 0 ? ShareInterval() : wilsonInterval(missed, contacts);
    }
};

using SweepFinders = std::vector<std::unique_ptr<SweepFinder>>;

/// One of each method, that knows the frame's objects.
[[nodiscard]] SweepFinders makeFinders(std::span<const SweepMethod> methods,
                                       const SweptFrame& frame);

/// Lets all methods do the frame, those that are slow only where `frameNumber` is a multiple of their
/// oneFrameIn, and counts what they get wrong. `tallies` has one a method.
void judgeFrame(std::span<const SweepMethod> methods, const SweepFinders& finders,
                const SweptFrame& frame, int frameNumber, std::span<SweepTally> tallies);

}  // namespace hashphase::demos
