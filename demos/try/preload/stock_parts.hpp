// SPDX-License-Identifier: Zlib
#pragma once

namespace hashphase::tryout {

/// While it lives, what its thread makes are parts of one of Bullet's own broadphases: left as they are, and
/// not counted.
class StockParts {
public:
    StockParts() noexcept { ++depth_; }
    ~StockParts() { --depth_; }
    StockParts(const StockParts&) = delete;
    StockParts& operator=(const StockParts&) = delete;

    [[nodiscard]] static bool areBeingMade() noexcept { return depth_ > 0; }

private:
    inline static thread_local int depth_ = 0;
};

}  // namespace hashphase::tryout
