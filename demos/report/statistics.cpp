// SPDX-License-Identifier: Zlib
#include <demos/report/statistics.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace hashphase::demos {

double percentile(const std::vector<double>& sorted, double share) {
    const double rank = share * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(rank);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return std::lerp(sorted[below], sorted[above], rank - static_cast<double>(below));
}

Spread spreadOf(std::vector<double> series) {
    std::sort(series.begin(), series.end());
    return {percentile(series, 0.5), percentile(series, 0.05), percentile(series, 0.95)};
}

}  // namespace hashphase::demos
