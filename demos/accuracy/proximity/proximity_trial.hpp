// SPDX-License-Identifier: Zlib
#pragma once

// What ways to know one's neighbours get wrong, and what they cost, in a crowd that wanders.

#include <demos/accuracy/proximity/neighbour_method.hpp>
#include <demos/report/statistics.hpp>

namespace hashphase::demos {

/// A crowd on a square, as large as that takes.
struct ProximityCase {
    std::string name;
    std::size_t agents = 0;
    double neighbours = 20;  // others within the radius, on average
    double radius = 5;       // [m], a multiple of 1/256
    double radiusByCell = 1;
    bool isTask = true;         // its ways compete as choices
    bool hasAllMethods = true;  // else only those to which the cell size matters

    [[nodiscard]] double cellSize() const { return radius / radiusByCell; }
    [[nodiscard]] double side() const;  // of the square [m]
};

struct ProximityPlan {
    int judgedFrames = 8;  // a multiple of framesTogether
    int rounds = 8;
    int framesTogether = 8;  // a multiple of every period of stale decisions
    std::size_t mostJudgedAgents = 1000;
};

/// Sums over the judged agents and frames, and times.
struct ProximityMeasurement {
    int judgedFrames = 0;
    std::uint64_t neighbours = 0;  // true ones
    std::uint64_t found = 0;       // of these
    std::uint64_t wrongly = 0;     // named, but no neighbours
    std::uint64_t decisions = 0;
    std::uint64_t wrong = 0;  // another colour than the rarest, of equally rare ones the lowest
    std::uint64_t worse = 0;  // a colour that more neighbours have than the rarest
    Spread time;              // [ms] a frame, for all agents

    [[nodiscard]] double recall() const;
    [[nodiscard]] std::optional<double> precision() const;  // none where nobody is named
    [[nodiscard]] double wrongShare() const;
};

inline constexpr double kAgentEdge = 0.5;  // [m]

/// A measurement for each method. Truth: the distance to every other agent, in double precision.
/// Throws std::invalid_argument where no agent has its surroundings within the square.
[[nodiscard]] std::vector<ProximityMeasurement> tryProximity(
    const ProximityCase& crowd, std::span<const NeighbourMethod> methods, const ProximityPlan& plan,
    std::uint64_t seed);

}  // namespace hashphase::demos
