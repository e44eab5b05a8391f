// SPDX-License-Identifier: Zlib
#pragma once

// Ways to find out what a camera sees of objects that stand on flat ground at height 0.

#include <demos/scenes/camera_view.hpp>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace hashphase::demos {

/// What a look at the scene took.
struct CullingCost {
    std::uint64_t cells = 0;  // tested or walked through: rows of cells, or nodes, where those are
    std::uint64_t boxes = 0;  // tested one by one
};

/// The objects that are to be drawn, a bit each.
class DrawList {
public:
    explicit DrawList(std::size_t objects) : bits_((objects + 63) / 64) {}

    void clear() { std::fill(bits_.begin(), bits_.end(), 0); }
    void add(std::uint32_t object) { bits_[object / 64] |= std::uint64_t{1} << (object % 64); }
    [[nodiscard]] bool has(std::uint32_t object) const {
        return (bits_[object / 64] >> (object % 64) & 1) != 0;
    }
    [[nodiscard]] std::vector<std::uint64_t>& bits() { return bits_; }

private:
    std::vector<std::uint64_t> bits_;
};

/// A method that has filed a scene.
class Culling {
public:
    Culling() = default;
    Culling(const Culling&) = delete;
    Culling& operator=(const Culling&) = delete;
    virtual ~Culling() = default;

    /// Finds what is to be drawn; this is what is timed.
    virtual CullingCost look(const CameraView& view) = 0;

    /// Whether the last look() found the object.
    [[nodiscard]] virtual bool draws(std::uint32_t object) const = 0;
};

struct CullingScene {
    std::span<const Aabb<float>> boxes;
    float tallest;   // no object is higher [m]
    float cellSize;  // of methods that must be told [m]
};

struct CullingMethod {
    std::string name;
    bool isOurs = false;
    bool mustSeeAll = false;   // a visible object that it does not draw breaks a check
    bool mustBeExact = false;  // as does one that it draws in vain, but for rounding
    bool takesCells = false;   // the scene's cell size matters
    std::function<std::unique_ptr<Culling>(const CullingScene&)> make;
};

/// The paper's and others' on the paper's map of cells.
[[nodiscard]] std::vector<CullingMethod> mapCullingMethods();

/// The library's, then Bullet's.
[[nodiscard]] std::vector<CullingMethod> gridCullingMethods();

/// All of them.
[[nodiscard]] std::vector<CullingMethod> cullingMethods();

}  // namespace hashphase::demos
