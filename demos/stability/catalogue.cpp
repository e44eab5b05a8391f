// SPDX-License-Identifier: Zlib
#include <demos/stability/catalogue.hpp>

#include <demos/stability/cases/cases.hpp>

#include <algorithm>
#include <cstdlib>
#include <vector>

namespace hashphase::demos {
namespace {

int numberOf(const HardCase& hardCase) {
    return std::atoi(hardCase.id + 1);
}

std::vector<HardCase> collect() {
    std::vector<HardCase> all;
    for (const std::span<const HardCase> group :
         {numberCases(), borderCases(), rayCases(), sweepCases(), sizeCases(), crowdCases(),
          churnCases(), withinCases(), bodyCases(), repeatCases(), groundCases(), viewCases(),
          proximityCases()}) {
        all.insert(all.end(), group.begin(), group.end());
    }
    std::sort(all.begin(), all.end(),
              [](const HardCase& a, const HardCase& b) { return numberOf(a) < numberOf(b); });
    return all;
}

}  // namespace

std::span<const HardCase> hardCases() {
    static const std::vector<HardCase> kAll = collect();
    return kAll;
}

}  // namespace hashphase::demos
