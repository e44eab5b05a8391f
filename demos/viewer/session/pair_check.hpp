// SPDX-License-Identifier: Zlib
#pragma once

// Compares the pairs that a stage's broadphase has found with the exact ones.

#include <demos/viewer/stage/stage.hpp>

#include <cstddef>
#include <vector>

namespace hashphase::demos {

class PairCheck {
public:
    /// Looks at the last frame. Cost: the boxes are sorted along one axis.
    void look(const Stage& stage);

    [[nodiscard]] std::size_t exactCount() const noexcept { return exact_.size(); }

    /// Pairs that overlap and are not listed: wrong answers; and pairs that are listed and do not overlap: they
    /// cost time. Sorted.
    [[nodiscard]] const std::vector<PairKey>& missing() const noexcept { return missing_; }
    [[nodiscard]] const std::vector<PairKey>& extra() const noexcept { return extra_; }

private:
    std::vector<Aabb<float>> boxes_;
    std::vector<CollisionFilter> filters_;
    std::vector<PairKey> listed_;
    std::vector<PairKey> exact_;
    std::vector<PairKey> missing_;
    std::vector<PairKey> extra_;
};

}  // namespace hashphase::demos
