// SPDX-License-Identifier: Zlib
#pragma once

// How well each kind of bounding volume works as a first pass for bodies that are not round (the
// paper's "efficiency of hashing different bounding volume types").

#include <demos/paper/stick_scene.hpp>
#include <demos/report/check.hpp>

#include <string_view>
#include <vector>

namespace hashphase::demos {

/// Of one kind of volume; counts are means of the frames.
struct VolumeResult {
    VolumeKind kind = VolumeKind::sphere;
    std::vector<double> firstPassMs;  // all boxes moved, couples found and their volumes compared
    std::vector<double> exactMs;      // the exact test of what passed
    double candidates = 0;            // couples whose boxes overlap
    double passed = 0;                // of these, whose volumes overlap
    double touching = 0;              // of these, who touch
};

struct VolumeResults {
    std::uint32_t sticks = 0;
    std::vector<VolumeResult> volumes;  // by kind
    std::vector<Check> checks;
};

[[nodiscard]] std::string_view nameOf(VolumeKind kind);

/// All kinds in turn in each frame. In the first one, which is not timed, they are compared with
/// the exact test of all couples.
[[nodiscard]] VolumeResults measureVolumes(std::uint32_t sticks, std::uint32_t frames,
                                           std::uint64_t seed);

}  // namespace hashphase::demos
