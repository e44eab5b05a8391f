// SPDX-License-Identifier: Zlib
#pragma once

#include <tests/support/count_allocations.hpp>

#include <LinearMath/btAlignedAllocator.h>

#include <cstdlib>

namespace hashphase::test {

/// While it lives, allocationCount() counts what Bullet allocates, too.
struct CountedBullet {
    CountedBullet() { btAlignedAllocSetCustom(countedAllocate, std::free); }
    ~CountedBullet() { btAlignedAllocSetCustom(nullptr, nullptr); }
    CountedBullet(const CountedBullet&) = delete;
    CountedBullet& operator=(const CountedBullet&) = delete;
};

}  // namespace hashphase::test
