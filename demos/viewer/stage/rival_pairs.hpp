// SPDX-License-Identifier: Zlib
#pragma once

// Pairs found by one of Bullet's broadphases, of boxes that somebody else moves.

#include <demos/compare/filled_broadphase.hpp>
#include <demos/viewer/stage/phases.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace hashphase::demos {

class RivalPairs {
public:
    /// For indices below `indexLimit`, in boxes that stay within `bounds`, as far as the broadphase cares.
    RivalPairs(const BroadphaseKind& kind, const Aabb<float>& bounds, std::size_t indexLimit);

    /// Takes the boxes, by index, NaN for who is not there, and finds the pairs; at most `indexLimit`
    /// boxes, of which filters are empty where all may pair. The clock is told how long each takes.
    void update(std::span<const Aabb<float>> boxes, std::span<const CollisionFilter> filters,
                PhaseClock& clock);

    /// Forgets pairs of the last update.
    template <class IsGone>
    void eraseIf(const IsGone& isGone) {
        std::erase_if(pairs_, isGone);
    }

    /// As the broadphase lists them, sorted.
    [[nodiscard]] const std::vector<PairKey>& pairs() const noexcept { return pairs_; }
    /// As HeapMeter::bytes().
    [[nodiscard]] std::optional<std::int64_t> memoryBytes() const noexcept {
        return broadphase_.heap().bytes();
    }

private:
    FilledBroadphase broadphase_;
    std::vector<char> isThere_;
    std::vector<BulletBox> bulletBoxes_;
    std::vector<PairKey> pairs_;
};

}  // namespace hashphase::demos
