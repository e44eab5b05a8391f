// SPDX-License-Identifier: Zlib
#pragma once

#include <cstddef>
#include <cstdint>

namespace hashphase::detail {

/// Says when memory that a peak has left behind is to be given back. It counts updates and looks at no
/// clock: the same calls do the same.
class PeakWatch {
public:
    /// To be told once an update how many there are, and for how many there is room. True when there
    /// has been room for more than eight times as many in 256 updates in a row.
    [[nodiscard]] bool isPast(std::size_t count, std::size_t room) noexcept {
        constexpr std::size_t kMuch = 8;
        constexpr std::size_t kWorthIt = 1024;
        constexpr std::uint32_t kUpdates = 256;
        updates_ = room > kMuch * count + kWorthIt ? updates_ + 1 : 0;
        if (updates_ < kUpdates) {
            return false;
        }
        updates_ = 0;
        return true;
    }

private:
    std::uint32_t updates_ = 0;
};

}  // namespace hashphase::detail
