// SPDX-License-Identifier: Zlib
#pragma once

// What moving boxes really touch, and when: in integers, so nothing is rounded, and of all pairs. It
// shares no code with the library.

#include <demos/accuracy/sweeps/sweep_method.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace hashphase::demos {

/// A time, as a share of the frame.
struct Moment {
    std::int64_t numerator = 0;
    std::int64_t denominator = 1;  // above 0

    /// How far a time that was computed lies from it [shares of the frame].
    [[nodiscard]] double errorOf(double time) const;

    [[nodiscard]] double value() const {
        return static_cast<double>(numerator) / static_cast<double>(denominator);
    }

    friend bool operator<(const Moment& a, const Moment& b) {
        return a.numerator * b.denominator < b.numerator * a.denominator;
    }
};

/// When the two objects of the frame touch first; nothing when they never do. Throws std::logic_error
/// for coordinates that are no multiples of the frame's unit.
[[nodiscard]] std::optional<Moment> exactContact(const SweptFrame& frame, std::uint32_t a,
                                                 std::uint32_t b);

struct SweepTruth {
    std::vector<PairKey> contacts;  // that begin during the frame, of one mover at least; sorted
    std::vector<Moment> moments;    // when each begins
    std::vector<PairKey>
        older;  // that touch when the frame begins, found in the one before; sorted
};

[[nodiscard]] SweepTruth findTruth(const SweptFrame& frame);

}  // namespace hashphase::demos
