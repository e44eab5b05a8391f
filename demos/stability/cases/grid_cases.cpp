// SPDX-License-Identifier: Zlib
#include <demos/stability/cases/cases.hpp>

#include <cstdlib>

namespace hashphase::demos {

std::vector<HardCase> inOrder(std::initializer_list<std::span<const HardCase>> groups) {
    std::vector<HardCase> all;
    for (const std::span<const HardCase> group : groups) {
        all.insert(all.end(), group.begin(), group.end());
    }
    std::sort(all.begin(), all.end(), [](const HardCase& a, const HardCase& b) {
        return std::atoi(a.id + 1) < std::atoi(b.id + 1);
    });
    return all;
}

std::span<const HardCase> gridCases() {
    static const std::vector<HardCase> kAll =
        inOrder({numberCases(), borderCases(), roundingCases(), rayCases(), longRayCases(),
                 sweepCases(), sizeCases(), crowdCases(), churnCases(), repeatCases(),
                 groundCases(), viewCases(), proximityCases(), rollbackCases()});
    return kAll;
}

}  // namespace hashphase::demos
