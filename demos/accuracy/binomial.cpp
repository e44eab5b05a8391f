// SPDX-License-Identifier: Zlib
#include <demos/accuracy/binomial.hpp>

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

}  // namespace hashphase::demos
