// SPDX-License-Identifier: Zlib
#include <demos/accuracy/binomial.hpp>

#include <algorithm>
#include <cmath>

namespace hashphase::demos {

ShareInterval wilsonInterval(std::uint64_t hits, std::uint64_t trials) {
    constexpr double z = 1.959963984540054;  // 97.5th percentile of the normal distribution
    const auto n = static_cast<double>(trials);
    const double share = static_cast<double>(hits) / n;
    const double centre = (share + z * z / (2 * n)) / (1 + z * z / n);
    const double reach =
        z / (1 + z * z / n) * std::sqrt(share * (1 - share) / n + z * z / (4 * n * n));
    return {hits == 0 ? 0 : centre - reach, hits == trials ? 1 : centre + reach};
}

ShareInterval intervalOverFrames(std::uint64_t hits, std::uint64_t trials, int frames) {
    const auto count = static_cast<std::uint64_t>(frames);
    const std::uint64_t trialsOfOne = std::max<std::uint64_t>(trials / count, 1);
    const std::uint64_t hitsOfOne = std::min((hits + count / 2) / count, trialsOfOne);
    const ShareInterval interval = wilsonInterval(hitsOfOne, trialsOfOne);
    const double share = static_cast<double>(hits) / static_cast<double>(trials);
    return {std::min(interval.low, share), std::max(interval.high, share)};
}

}  // namespace hashphase::demos
