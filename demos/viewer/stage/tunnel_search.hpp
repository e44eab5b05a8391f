// SPDX-License-Identifier: Zlib
#pragma once

// Who has passed through a wall from one frame to the next.

#include <demos/viewer/stage/stage.hpp>

#include <span>
#include <vector>

namespace hashphase::demos {

class TunnelSearch {
public:
    /// Before a frame.
    void notePlaces(const Stage& stage);

    /// After it: marks spheres that have moved by more than their radius and have a static box between where
    /// they were and where they are. Needs a grid. Cost: a ray for each sphere that is so fast.
    void find(const Stage& stage);

    /// Of all frames, up to kMostMarks.
    [[nodiscard]] std::span<const TunnelMark> marks() const noexcept { return marks_; }

    static constexpr std::size_t kMostMarks = 2000;

private:
    std::vector<Vector3<float>> before_;  // where bodies were, by index
    std::vector<TunnelMark> marks_;
    std::vector<Picked<float>> picked_;  // scratch
};

}  // namespace hashphase::demos
