// SPDX-License-Identifier: Zlib
#pragma once

// Times the steps of the program that this library is loaded into, and writes them to the record that
// it was asked for; without one, nothing is timed.
//
// Threads  any, at once: worlds may be stepped on several, and rays cast from any.

#include <demos/try/preload/clocks.hpp>
#include <demos/try/record.hpp>

#include <cstddef>
#include <cstdint>

class btOverlappingPairCache;

namespace hashphase::tryout {

/// The record of this process; nullptr where none was asked for, or another process has it. Who asks
/// first, for its first broadphase, has it from then on, and its steps are timed.
[[nodiscard]] Record* record() noexcept;

/// Which broadphase the program gets: what the record says; ours without one.
[[nodiscard]] Broadphase wantedBroadphase() noexcept;

void noteDbvts(int change);
void noteAxisSweep();
void noteDerivedSweep();
void noteObjects(int change) noexcept;

/// What is timed in a step, on the thread that makes it. Rays in it are counted elsewhere.
enum class Part : std::uint8_t { updateAabbs, calculate, narrowPhase };
inline constexpr std::size_t kPartCount = 3;

struct PartBegin {
    Moment moment;
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

// Of what is watched around the broadphases (profile_zones.hpp), on the caller's thread.

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
