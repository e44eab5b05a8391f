// SPDX-License-Identifier: Zlib
#pragma once

// P3: what an AI agent that asks only roughly who is near gets wrong, and what it saves. Its decision is
// that of the paper's AI: of some colours, to take the one that fewest of the neighbours have.

#include <broadphase/function_ref.hpp>
#include <demos/accuracy/experiment.hpp>
#include <demos/compare/filled_broadphase.hpp>
#include <demos/scenes/random.hpp>

#include <array>

namespace hashphase::demos {

using ColourCounts = std::array<std::uint32_t, 4>;

/// Of equally rare colours the lowest.
[[nodiscard]] std::uint32_t rarestOf(const ColourCounts& counts);

/// A frame: where the agents are. Agents are numbered by their place here.
struct AgentFrame {
    std::span<const Aabb<float>> boxes;
    std::span<const BulletBox> bulletBoxes;  // the same
};

/// One way at work.
struct NeighbourSearch {
    using Visit = FunctionRef<void(std::uint32_t agent, std::span<const std::uint32_t> neighbours)>;

    /// A frame: takes the agents as they are now; as many as in the first call.
    std::function<void(const AgentFrame&)> take;

    /// Calls visit for every agent, with those that count as its neighbours, in any order.
    std::function<void(Visit)> forEach;

    /// Sets chosen[agent] to the rarest colour among its neighbours; empty: from their list.
    std::function<void(std::span<const std::uint32_t> colours, std::span<std::uint32_t> chosen)>
        decide = {};
};

/// What a search is made for.
struct NeighbourNeeds {
    std::size_t agents = 0;
    Aabb<float> bounds;
    float radius = 0;    // [m]
    float cellSize = 0;  // [m]
};

/// exact       finds the neighbours and nobody else
/// complete    misses nobody, but may name others
/// estimate    the same, by the library's cells: its precision is as proximity.hpp tells
/// uses_cells  of NeighbourNeeds::cellSize, in time or in errors
using NeighbourMethod = Method<NeighbourSearch(const NeighbourNeeds&)>;

/// The library's; then the paper's as it prints it, with a flat grid and the cells from base -
/// offset to base + offset - 1; then Bullet's: btDbvtBroadphase::aabbTest() around each agent, and
/// the distance to all whom it finds, without any pairs on the way.
[[nodiscard]] std::vector<NeighbourMethod> neighbourMethods();

// --- Scenes ----------------------------------------------------------------------------------------

struct AgentPlan {
    std::size_t agents = 0;
    double side = 0;    // of the square or cube [m]; at most 60 km
    double edge = 0.5;  // of an agent's box [m], a multiple of 1/128
    double step = 0;    // largest move on an axis in a frame [m]
    bool isFlat = true;
};

/// Agents that wander over a square or through a cube, at places where single precision tells who is within
/// up to 16 m without rounding: coordinates are multiples of 1/256 m.
class AgentScene : public BoxScene {
public:
    AgentScene(const AgentPlan& plan, std::uint64_t seed);

    void advance() override { moveBy(-step_, step_); }
    [[nodiscard]] Aabb<float> bounds() const override;

private:
    using Place = std::array<std::int32_t, 3>;  // [m / 256]

    /// Each agent by a random way from low to high along each axis, and sets the boxes.
    void moveBy(std::int32_t low, std::int32_t high);

    Random random_;
    bool isFlat_;
    std::int32_t side_;
    std::int32_t step_;
    float halfEdge_;
    std::vector<Place> places_;  // of centres
};

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
