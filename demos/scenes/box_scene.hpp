// SPDX-License-Identifier: Zlib
#pragma once

// A scene of boxes that move without dynamics, for measuring and checking broadphases.
//
// Frame       advance() moves every box by one frame of 1/60 s; boxes() is what holds now.
// Repeatable  The boxes of frame n depend on the scene's arguments, its seed and n alone.
// Units       metres, seconds.

#include <demos/scenes/terrain.hpp>

#include <broadphase/aabb.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace hashphase::demos {

/// Which objects may pair with which, in Bullet's terms. The defaults are those of a moving body.
struct CollisionFilter {
    int group = 1;
    int mask = -1;
};

/// The filter of level geometry: pairs with everything but its like.
inline constexpr CollisionFilter kStaticFilter{2, ~2};

/// True of level geometry.
[[nodiscard]] inline bool isStatic(CollisionFilter filter) noexcept {
    return (filter.group & kStaticFilter.group) != 0;
}

/// Bullet's default rule: each one's mask accepts the other's group.
[[nodiscard]] inline bool mayPair(CollisionFilter a, CollisionFilter b) noexcept {
    return (a.group & b.mask) != 0 && (b.group & a.mask) != 0;
}

class BoxScene {
public:
    BoxScene() = default;
    BoxScene(const BoxScene&) = delete;
    BoxScene& operator=(const BoxScene&) = delete;
    virtual ~BoxScene() = default;

    /// Moves to the next frame. Throws InputError when a file it plays turns out broken.
    virtual void advance() = 0;

    /// The boxes of the current frame; their number and order never change.
    [[nodiscard]] const std::vector<Aabb<float>>& boxes() const noexcept { return boxes_; }

    /// One filter a box, or empty when every box has the default one.
    [[nodiscard]] const std::vector<CollisionFilter>& filters() const noexcept { return filters_; }

    /// A box that no box of any frame leaves.
    [[nodiscard]] virtual Aabb<float> bounds() const = 0;

    /// The ground under the objects, within the bounds; empty for a scene without ground. May outlive the scene.
    [[nodiscard]] virtual GroundHeight ground() const { return {}; }

    /// How many frames there are, where that is limited.
    [[nodiscard]] virtual std::optional<int> frameLimit() const { return std::nullopt; }

protected:
    std::vector<Aabb<float>> boxes_;
    std::vector<CollisionFilter> filters_;
};

/// The filter of one box of the scene.
[[nodiscard]] inline CollisionFilter filterOf(const BoxScene& scene, std::size_t object) {
    return scene.filters().empty() ? CollisionFilter{} : scene.filters()[object];
}

/// A scene that can be asked for by name.
struct BoxSceneKind {
    std::string_view name;
    std::string_view description;
    std::string_view noun;  // what its objects are, in the plural
    std::size_t defaultObjects;
    std::unique_ptr<BoxScene> (*make)(std::size_t objects, std::uint64_t seed);
};

/// Every built-in scene of boxes, the default one first.
[[nodiscard]] std::span<const BoxSceneKind> boxSceneKinds();

}  // namespace hashphase::demos
