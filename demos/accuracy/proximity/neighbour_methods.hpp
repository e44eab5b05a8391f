// SPDX-License-Identifier: Zlib
#pragma once

// Ways to know who is near an agent, and the decision that the paper's AI takes from it: of some
// colours, to take the one that fewest of the neighbours have.

#include <broadphase/function_ref.hpp>
#include <demos/accuracy/pairs/pair_method.hpp>

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
class NeighbourSearch {
public:
    using Visit = FunctionRef<void(std::uint32_t agent, std::span<const std::uint32_t> neighbours)>;

    NeighbourSearch() = default;
    NeighbourSearch(const NeighbourSearch&) = delete;
    NeighbourSearch& operator=(const NeighbourSearch&) = delete;
    virtual ~NeighbourSearch() = default;

    /// A frame: takes the agents as they are now; as many as in the first call.
    virtual void take(const AgentFrame& frame) = 0;

    /// Calls visit for every agent, with those that count as its neighbours, in any order.
    virtual void forEach(Visit visit) = 0;

    /// Sets chosen[agent] to the rarest colour among its neighbours.
    virtual void decide(std::span<const std::uint32_t> colours, std::span<std::uint32_t> chosen);
};

/// What a search is made for.
struct NeighbourNeeds {
    std::size_t agents = 0;
    Aabb<float> bounds;
    float radius = 0;    // [m]
    float cellSize = 0;  // [m]
};

enum class NeighbourPromise {
    kNone,
    kComplete,  // misses nobody, but may name others
    kEstimate,  // the same, by the library's cells: its precision is as proximity.hpp tells
    kExact,
};

struct NeighbourMethod {
    std::string name;
    std::function<std::unique_ptr<NeighbourSearch>(const NeighbourNeeds&)> make;
    NeighbourPromise promise = NeighbourPromise::kNone;
    bool usesCells = true;  // of NeighbourNeeds::cellSize, in time or in errors
    std::string_view origin = kOurs;
};

/// The library's; then the paper's as it prints it, with a flat grid and the cells from base -
/// offset to base + offset - 1; then Bullet's: btDbvtBroadphase::aabbTest() around each agent, and
/// the distance to all whom it finds, without any pairs on the way.
[[nodiscard]] std::vector<NeighbourMethod> neighbourMethods();

}  // namespace hashphase::demos
