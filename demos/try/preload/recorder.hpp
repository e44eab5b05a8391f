// SPDX-License-Identifier: Zlib
#pragma once

// Times the steps of the program that this library is loaded into, and writes them to the record that
// it was asked for; without one, nothing is timed.
//
// Threads  any, at once: worlds may be stepped on several, and rays cast from any.

#include <demos/try/record.hpp>

#include <cstdint>

class btOverlappingPairCache;

namespace hashphase::tryout {

/// The record of this process; nullptr where none was asked for, or another process has it.
[[nodiscard]] Record* record() noexcept;

/// Which broadphase the program gets: without a record, ours.
[[nodiscard]] Broadphase wantedBroadphase() noexcept;

/// Notes that a broadphase was made, and from the first one on times Bullet's profile zones.
void noteDbvt();

/// The same; whether the sweep has made a btDbvtBroadphase of its own, which is not the program's.
void noteAxisSweep(bool hasMadeDbvt);

void noteObjects(int change) noexcept;

/// Around calculateOverlappingPairs() of one broadphase. Cost: two looks at the clock, and now and
/// then one at each pair, to count those that overlap: at most a two-hundredth of the time.
class CalculateScope {
public:
    explicit CalculateScope(btOverlappingPairCache& cache) noexcept;
    ~CalculateScope();
    CalculateScope(const CalculateScope&) = delete;
    CalculateScope& operator=(const CalculateScope&) = delete;

private:
    btOverlappingPairCache& cache_;
    std::int64_t begin_;
};

/// Around a ray; those that a ray's callback casts count as part of it.
class RayScope {
public:
    RayScope() noexcept;
    ~RayScope();
    RayScope(const RayScope&) = delete;
    RayScope& operator=(const RayScope&) = delete;

private:
    std::int64_t begin_;
};

}  // namespace hashphase::tryout
