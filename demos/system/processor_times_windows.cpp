// SPDX-License-Identifier: Zlib
#include <demos/system/other_programs.hpp>

namespace hashphase::demos {

std::optional<ProcessorTimes> processorTimes() {
    return std::nullopt;
}

}  // namespace hashphase::demos
