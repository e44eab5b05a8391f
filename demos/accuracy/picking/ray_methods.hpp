// SPDX-License-Identifier: Zlib
#pragma once

// Ways to find the boxes that a ray meets.

#include <broadphase/aabb.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace hashphase::demos {

struct Ray {
    Vector3<float> from;
    Vector3<float> to;
};

struct RayHit {
    std::uint32_t object;
    float fraction;  // of the ray's length, where it enters
};

/// What rays took; methods that do not tell leave it at 0.
struct RayCost {
    std::uint64_t cells = 0;  // or blocks of boxes, of the library's tree
    std::uint64_t boxes = 0;
};

/// A method that has filed a scene.
class RayCaster {
public:
    RayCaster() = default;
    RayCaster(const RayCaster&) = delete;
    RayCaster& operator=(const RayCaster&) = delete;
    virtual ~RayCaster() = default;

    /// Appends each box that it finds, once.
    virtual RayCost cast(const Ray& ray, std::vector<RayHit>& hits) = 0;
};

struct RayMethod {
    std::string name;
    bool isOurs = false;
    bool mustFindAll = false;  // a box that is hit and not found breaks a check
    bool findsNearestOnly = false;
    bool walksCells = false;  // takes time for each cell of a long ray
    std::function<std::unique_ptr<RayCaster>(std::span<const Aabb<float>>)> make;
};

/// Through plain cells of 1 m; the paper's first.
[[nodiscard]] std::vector<RayMethod> cellRayMethods();

/// The library's, then Bullet's.
[[nodiscard]] std::vector<RayMethod> treeRayMethods();

/// All of them.
[[nodiscard]] std::vector<RayMethod> rayMethods();

}  // namespace hashphase::demos
