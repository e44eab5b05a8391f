// SPDX-License-Identifier: Zlib
#pragma once

// The middle of a series of measurements, and how far it spreads.

#include <vector>

namespace hashphase::demos {

struct Spread {
    double median = 0;
    double low = 0;   // 5th percentile
    double high = 0;  // 95th percentile
};

/// The value below which `share` (0 to 1) of the sorted series lies, interpolated between
/// neighbours. The series must not be empty.
[[nodiscard]] double percentile(const std::vector<double>& sorted, double share);

/// Median and percentiles of a series in any order; it must not be empty.
[[nodiscard]] Spread spreadOf(std::vector<double> series);

}  // namespace hashphase::demos
