// SPDX-License-Identifier: Zlib
#pragma once

// What more ranks than there are here would have to tell each other: space is cut for them, and spheres drawn at
// random are asked which ranks they touch, in one frame and in the next. Counted, but for the times, which follow
// from a model of a machine.

#include <demos/report/data_table.hpp>
#include <demos/swarm/swarm_scene.hpp>

#include <cstdint>
#include <functional>
#include <vector>

namespace hashphase::demos {

/// A machine, by figures that its owner can measure.
struct MachineModel {
    double objectNanoseconds = 75;  // a sphere's share of a frame on one rank, by `hashphase swarm`
    double ghostNanoseconds = 300;  // a ghost's, taking what is told of it included
    double messageMicroseconds = 2;  // to send or to take a message
    double stepMicroseconds =
        2;  // of a barrier or a sum over all ranks, which takes log2(ranks) of them
    double bytesPerNanosecond = 10;  // of a rank's share of the network: 10 GB/s
};

struct PlanSize {
    std::uint64_t objects = 0;
    std::uint32_t ranks = 0;
};

/// What one rank has to do, on average over all ranks.
struct PlannedFrame {
    PlanSize size;
    double objects = 0;     // that live there
    double ghosts = 0;      // that are there
    double migrations = 0;  // objects that leave
    double newGhosts = 0;
    double bytes = 0;  // sent
    double messages = 0;
    double mostMessages = 0;  // of the rank that has the most
    double workMs = 0;        // by the model: spheres and ghosts
    double exchangeMs = 0;    // by the model: messages, bytes, barrier and sums
    double efficiency = 0;    // of the time that the spheres alone would take
};

/// The mean over some million random spheres. Cost: seconds.
[[nodiscard]] PlannedFrame planFrame(SwarmKind kind, std::uint64_t seed, const PlanSize& size,
                                     const MachineModel& model);

/// 1e7, 1e8 and 1e9 spheres on 64 to 16,384 ranks.
[[nodiscard]] std::vector<PlanSize> plannedSizes();

[[nodiscard]] DataTable planTable(const std::vector<PlannedFrame>& frames);

/// For each number of spheres a sentence that says up to how many ranks half of all time goes to spheres.
[[nodiscard]] std::vector<std::string> planSentences(const std::vector<PlannedFrame>& frames);

}  // namespace hashphase::demos
