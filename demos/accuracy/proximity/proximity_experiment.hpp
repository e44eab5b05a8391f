// SPDX-License-Identifier: Zlib
#pragma once

// P3: what an AI agent that asks only roughly who is near gets wrong, and what it saves.

#include <demos/accuracy/experiment.hpp>
#include <demos/accuracy/proximity/neighbour_methods.hpp>

namespace hashphase::demos {

/// Agents on a square, as large as that takes.
struct Crowd {
    std::string name;
    std::size_t agents = 0;
    double neighbours = 20;  // others within the radius, on average
    double radius = 5;       // [m], a multiple of 1/256
    double radiusByCell = 1;
    bool hasAllMethods = true;  // else only those to which the cell size matters

    [[nodiscard]] double cellSize() const { return radius / radiusByCell; }
    [[nodiscard]] double side() const;  // of the square [m]
};

struct ProximityPlan {
    std::vector<Crowd> crowds;  // those of the same name, which differ by their cells, together
    int judgedFrames = 8;       // a multiple of framesTogether
    int rounds = 8;
    int framesTogether = 8;  // a multiple of every period of stale decisions
    std::size_t mostJudgedAgents = 1000;
    std::size_t statedEstimates = 300;
};

/// Tries the methods in all crowds, and says what that shows (proximity.sql). Truth: the distance
/// to every other agent, in double precision. Throws std::invalid_argument where no agent has its
/// surroundings within the square.
[[nodiscard]] Findings measureProximity(const ProximityPlan& plan,
                                        std::span<const NeighbourMethod> methods,
                                        std::uint64_t seed, const TellProgress& tell);

/// Counts what integration/ai/proximity.hpp states of estimateWithin() in space, for a radius of 1,
/// 2, 4 and 8 cells, agents half as large as a cell, twenty others in the ball; `estimates` queries
/// each.
void measureStatedEstimates(std::size_t estimates, std::uint64_t seed, Measurements& measured);

}  // namespace hashphase::demos
