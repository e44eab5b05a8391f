// SPDX-License-Identifier: Zlib
#include <broadphase/grid_config.hpp>

#include <sstream>

namespace hashphase {
namespace {

template <class Number>
std::string rangeError(const char* field, Number value, const char* valid) {
    std::ostringstream sentence;
    sentence << "GridConfig::" << field << " is " << value << ", but must be " << valid << '.';
    return sentence.str();
}

}  // namespace

std::string configError(const GridConfig& config) {
    // Each test is phrased so that NaN fails it.
    if (!(config.cellSize == 0 || (config.cellSize >= 1e-30 && config.cellSize <= 1e30))) {
        return rangeError("cellSize", config.cellSize,
                          "0 (choose automatically) or between 1e-30 and 1e30 [m]");
    }
    if (!(config.levelRatio >= 2 && config.levelRatio <= 64)) {
        return rangeError("levelRatio", config.levelRatio, "between 2 and 64");
    }
    if (config.updatesBeforeRest < 1 || config.updatesBeforeRest > 1'000'000) {
        return rangeError("updatesBeforeRest", config.updatesBeforeRest, "between 1 and 1000000");
    }
    if (config.slack && !(*config.slack >= 0 && *config.slack <= 1e30)) {
        return rangeError("slack", *config.slack,
                          "empty (follow each proxy's motion) or between 0 and 1e30 [m]");
    }
    return {};
}

}  // namespace hashphase
