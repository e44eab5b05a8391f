// SPDX-License-Identifier: Zlib
#pragma once

// How well each kind of bounding volume works as a first pass for bodies that are not round (the
// paper's "efficiency of hashing different bounding volume types").

#include <demos/paper/phase_measurement.hpp>
#include <demos/paper/stick_scene.hpp>

#include <string_view>
#include <vector>

namespace hashphase::demos {

/// Of one kind of volume; counts are means of the frames.
struct VolumeResult {
    VolumeKind kind = VolumeKind::sphere;
    std::vector<double> firstPassMs;  // all boxes moved, pairs found and their volumes compared
    std::vector<double> exactMs;      // the exact test of what passed
    double candidates = 0;            // pairs whose boxes overlap
    double passed = 0;                // of these, whose volumes overlap
    double touching = 0;              // of these, who touch
};

struct VolumeResults {
    std::uint32_t sticks = 0;
    std::uint32_t frames = 0;           // timed, of each kind
    std::vector<VolumeResult> volumes;  // by kind; none where no frame was timed
    std::vector<PaperCheck> checks;
};

[[nodiscard]] std::string_view nameOf(VolumeKind kind);

/// All kinds in turn in each frame, as many as the effort allows until the time is up. In the first
/// one, which is not timed, they are compared with the exact test of all pairs.
[[nodiscard]] VolumeResults measureVolumes(
    std::uint32_t sticks, const PhaseEffort& effort, std::uint64_t seed,
    const IsTimeUp& isTimeUp = [] { return false; });

}  // namespace hashphase::demos
