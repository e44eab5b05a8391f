// SPDX-License-Identifier: Zlib
#pragma once

// Boxes in a broadphase, and whether the pairs that it lists are the right ones.

#include <demos/compare/filled_broadphase.hpp>
#include <demos/report/frame_clock.hpp>
#include <demos/stability/hard_case.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace hashphase::demos {

using Boxes = std::vector<Aabb<float>>;
using Objects = std::vector<std::uint32_t>;

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A collector for Grid::visit(): the places of what is found.
struct NoteIndices {
    void add(ProxyId id, float /*key*/) { found.push_back(id.index); }
    [[nodiscard]] static float limit() { return kInfinity; }
    Objects found;
};

/// A callback of box queries: the objects of what is found.
struct NoteObjects final : btBroadphaseAabbCallback {
    bool process(const btBroadphaseProxy* proxy) override {
        found.push_back(FilledBroadphase::objectOf(*proxy));
        return true;
    }
    Objects found;
};

/// A box from its centre and its edge [m].
[[nodiscard]] Aabb<float> cubeAt(const Vector3<float>& center, float edge);

/// Cubes with their centres drawn from a cube around the origin; edges and side in metres.
[[nodiscard]] Boxes scatteredCubes(std::size_t count, float side, float smallestEdge,
                                   float largestEdge, std::uint64_t seed);

/// What the axis sweep takes as its world: all boxes but those without end.
[[nodiscard]] Aabb<float> worldOf(std::span<const Aabb<float>> boxes);

class PairScene {
public:
    /// Creates a proxy for each box. `grid` is for ours; `world` for the axis sweep, of which it is
    /// worldOf(boxes) otherwise.
    PairScene(const CaseContext& context, Boxes boxes, const GridConfig& grid = {},
              const std::optional<Aabb<float>>& world = std::nullopt);

    /// setAabb for one.
    void move(std::uint32_t object, const Aabb<float>& box);
    /// Destroys and creates one; a destroyed one is in no pair.
    void destroy(std::uint32_t object);
    void create(std::uint32_t object, const Aabb<float>& box);
    /// setAabb for all, unchanged ones too.
    void moveAll(const Boxes& boxes);

    /// calculateOverlappingPairs().
    void findPairs() { filled_.findPairs(); }

    /// What the cache lists, sorted.
    [[nodiscard]] const std::vector<PairKey>& reported();
    /// The pairs of boxes that touch, closed, sorted. Not counted against the time limit.
    [[nodiscard]] const std::vector<PairKey>& exact();

    /// Finds the pairs and compares them with the exact ones.
    void judge(CaseTally& tally);

    [[nodiscard]] const Boxes& boxes() const noexcept { return boxes_; }
    [[nodiscard]] std::uint32_t size() const noexcept {
        return static_cast<std::uint32_t>(boxes_.size());
    }
    [[nodiscard]] btBroadphaseInterface& broadphase() const noexcept {
        return filled_.broadphase();
    }
    /// Ours; nullptr for any other.
    [[nodiscard]] SpatialHashBroadphase* hash() const noexcept {
        return dynamic_cast<SpatialHashBroadphase*>(&filled_.broadphase());
    }

private:
    Boxes boxes_;
    std::vector<BulletBox> bulletBoxes_;
    FilledBroadphase filled_;
    std::vector<PairKey> reported_;
    std::vector<PairKey> exact_;
};

/// The pairs of some boxes, once.
void judgePairs(const CaseContext& context, CaseTally& tally, const Boxes& boxes,
                const GridConfig& grid = {});

/// What the work takes of the processor [ms]: the shortest of `times` runs.
template <class Work>
[[nodiscard]] double shortestTime(int times, const Work& work) {
    double shortest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < times; ++i) {
        const FrameClock clock;
        work();
        shortest = std::min(shortest, clock.milliseconds());
    }
    return shortest;
}

}  // namespace hashphase::demos
