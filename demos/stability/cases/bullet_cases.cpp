// SPDX-License-Identifier: Zlib
#include <demos/stability/bullet_subject.hpp>

namespace hashphase::demos {

std::span<const HardCase> bulletCases() {
    static const std::vector<HardCase> kAll = inOrder({bodyCases(), withinCases()});
    return kAll;
}

std::span<const HardCase> hardCases() {
    static const std::vector<HardCase> kAll = inOrder({gridCases(), bulletCases()});
    return kAll;
}

}  // namespace hashphase::demos
