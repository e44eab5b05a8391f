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

}  // namespace hashphase::demos
