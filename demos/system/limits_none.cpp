// SPDX-License-Identifier: Zlib
#include <demos/system/limits.hpp>

#include <chrono>

namespace hashphase::demos {

LimitPause::LimitPause() = default;
LimitPause::~LimitPause() = default;

bool MemoryLimit::isPossible() noexcept {
    return false;
}
MemoryLimit::MemoryLimit(std::uint64_t /*more*/) {}
MemoryLimit::~MemoryLimit() = default;

double threadMilliseconds() noexcept {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double, std::milli>(now).count();
}

}  // namespace hashphase::demos
