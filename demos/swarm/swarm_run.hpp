// SPDX-License-Identifier: Zlib
#pragma once

// A swarm over all ranks, frame by frame, and the same in one process.

#include <demos/swarm/swarm_scene.hpp>
#include <integration/mpi/distributed_grid.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace hashphase::demos {

/// What one rank did in one frame, as plain numbers that travel by MPI.
struct RankFrame {
    double objects = 0;
    double ghosts = 0;
    double load = 0;
    double bytes = 0;     // sent
    double messages = 0;  // sent
    double migrated = 0;  // objects that have gone to other ranks
    // Milliseconds.
    double place = 0;  // where all spheres are now: what a simulation does
    double rebalance = 0;
    double tell = 0;  // setting boxes, and packing what others have to be told
    double wait = 0;
    double pairs = 0;
    double whole = 0;  // all of these but `place`

    static constexpr std::size_t kNumbers = 12;
};

/// Sums that do not depend on who reports a pair.
struct FrameSums {
    PairSum born;
    PairSum died;

    friend bool operator==(const FrameSums&, const FrameSums&) = default;
};

/// What all ranks did, on rank 0; on the others only what is named.
struct SwarmResult {
    std::uint32_t ranks = 1;
    std::vector<std::vector<RankFrame>> frames;  // by frame, then rank
    std::vector<FrameSums> sums;                 // by frame, over all ranks; on all of them
    std::vector<bool> wasRebalanced;             // by frame
    PairSum last;                // the pairs of the last frame, over all ranks; on all of them
    bool isInterrupted = false;  // some rank was asked to end; on all of them
};

/// Called after each frame on every rank.
using SwarmWatch = std::function<void(std::uint32_t frame, const DistributedGrid<float>& grid)>;

/// Runs frames 0 to `frames` - 1 on all ranks of the communicator together; fewer if one of them is interrupted.
[[nodiscard]] SwarmResult runSwarm(MPI_Comm communicator, const SwarmScene& scene,
                                   std::uint32_t frames, const DistributedConfig& config,
                                   const SwarmWatch& watch);

/// The same in one process, by a Grid and its Pairs.
struct SingleResult {
    std::vector<FrameSums> sums;
    std::vector<double> place;  // [ms], as RankFrame's
    std::vector<double> whole;
    PairSum last;
};
[[nodiscard]] SingleResult runAlone(const SwarmScene& scene, std::uint32_t frames,
                                    const std::function<void(std::uint32_t frame)>& watch);

/// One process to compare with, if there is one.
struct SingleRun {
    std::optional<SingleResult> result;
    std::string fault;  // why the run has failed; empty: it has not, or it was not made
};

/// runAlone(), which may have too many spheres for one process. Passes on what `watch` throws, but for std::bad_alloc
/// and std::length_error.
[[nodiscard]] SingleRun tryAlone(const SwarmScene& scene, std::uint32_t frames,
                                 const std::function<void(std::uint32_t frame)>& watch);

/// Waits for all ranks, asleep.
void meet(MPI_Comm communicator);

}  // namespace hashphase::demos
