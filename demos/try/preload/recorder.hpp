// SPDX-License-Identifier: Zlib
#pragma once

// Times the steps of the program that this library is loaded into, and writes them to the record that
// it was asked for; without one, nothing is timed.
//
// Threads  any, at once: worlds may be stepped on several, and rays cast from any.

#include <demos/try/preload/clocks.hpp>
#include <demos/try/record.hpp>

#include <BulletCollision/BroadphaseCollision/btBroadphaseProxy.h>

#include <cstddef>
#include <cstdint>

class btOverlappingPairCache;

namespace hashphase::tryout {

/// Whether the boxes of two proxies overlap: closed, and never with NaN. It shares no code with the
/// library, whose judge it is.
[[nodiscard]] inline bool overlaps(const btBroadphaseProxy& a,
                                   const btBroadphaseProxy& b) noexcept {
    return a.m_aabbMin.x() <= b.m_aabbMax.x() && b.m_aabbMin.x() <= a.m_aabbMax.x() &&
           a.m_aabbMin.y() <= b.m_aabbMax.y() && b.m_aabbMin.y() <= a.m_aabbMax.y() &&
           a.m_aabbMin.z() <= b.m_aabbMax.z() && b.m_aabbMin.z() <= a.m_aabbMax.z();
}

/// The record of this process; nullptr where none was asked for, or another process has it. Who asks
/// first, for its first broadphase, has it from then on, and its steps are timed.
[[nodiscard]] Record* record() noexcept;

/// Which broadphase the program gets: what the record says; ours without one.
[[nodiscard]] Broadphase wantedBroadphase() noexcept;

void note(std::uint32_t Counts::*count, int change = 1);
void noteDerivedSweep();
void noteObjects(int change) noexcept;

/// What is timed in a step, on the thread that makes it. Rays in it are counted elsewhere.
enum class Part : std::uint8_t { updateAabbs, calculate, narrowPhase };
inline constexpr std::size_t kPartCount = 3;

struct PartBegin {
    ClockTimes moment;
    std::int64_t rays = 0;  // what this thread's have taken before
};

/// Around calculateOverlappingPairs() of one broadphase. Cost: two looks at the clocks, and now and
/// then one at each pair, to count those that overlap: at most 5 ms and a two-hundredth of the time.
class CalculateScope {
public:
    explicit CalculateScope(btOverlappingPairCache& cache) noexcept;
    ~CalculateScope();
    CalculateScope(const CalculateScope&) = delete;
    CalculateScope& operator=(const CalculateScope&) = delete;

private:
    btOverlappingPairCache& cache_;
    PartBegin begin_;
};

/// Watches, from now on, sub-steps, updateAabbs() and the narrow phase in them, by Bullet's own profile zones; and
/// whole steps by the worlds' stepSimulation(), which has none: where Bullet is linked so that this library can
/// stand in for it. What the program itself has Bullet call in its zones goes on being called.
void watchProfileZones();

// Of what is watched so, on the caller's thread.

/// A step, or a part of one: a step ends with its outermost part.
void beginStep() noexcept;
void endStep() noexcept;

/// Says to endPart() when it began.
[[nodiscard]] PartBegin beginPart() noexcept;
void endPart(Part part, const PartBegin& begin) noexcept;

/// How many CalculateScopes have ended.
[[nodiscard]] std::uint64_t calculationsOfThread() noexcept;

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
