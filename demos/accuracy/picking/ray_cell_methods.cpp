// SPDX-License-Identifier: Zlib
//
// Rays through plain cells. Whichever cells a method visits, the boxes in them are tested in the same
// way, so that methods differ by nothing else.

#include <demos/accuracy/picking/ray_methods.hpp>

#include <broadphase/regions.hpp>
#include <demos/accuracy/picking/cell_walks.hpp>

namespace hashphase::demos {
namespace {

/// Walk has kIsFlat and walk(ray, visit), which calls visit(cell).
template <class Walk>
class CellCaster final : public RayCaster {
public:
    CellCaster(std::span<const Aabb<float>> boxes, const Walk& walk)
        : boxes_(boxes), cells_(boxes, Walk::kIsFlat), walk_(walk), testedBy_(boxes.size(), 0) {}

    RayCost cast(const Ray& ray, std::vector<RayHit>& hits) override {
        ++number_;
        RayCost cost;
        const RayRegion<float> region(ray.from, ray.to);
        walk_.walk(ray, [&](const Cell& cell) {
            ++cost.cells;
            for (const std::uint32_t box : cells_.boxesIn(cell)) {
                if (testedBy_[box] == number_) {
                    continue;
                }
                testedBy_[box] = number_;
                ++cost.boxes;
                if (const float key = region.key(boxes_[box]); key >= 0) {
                    hits.push_back({box, key});
                }
            }
        });
        return cost;
    }

private:
    std::span<const Aabb<float>> boxes_;
    PlainCells cells_;
    Walk walk_;
    std::vector<std::uint32_t> testedBy_;  // the last ray that tested the box
    std::uint32_t number_ = 0;             // of the ray
};

/// The paper's picking in a grid of two dimensions: the cell in which the ray meets the ground.
struct PlanePoint {
    static constexpr bool kIsFlat = true;

    template <class Visit>
    void walk(const Ray& ray, const Visit& visit) const {
        const float fraction = (height - ray.from.y()) / (ray.to.y() - ray.from.y());
        if (fraction >= 0 && fraction <= 1) {
            const Vector3<float> point = ray.from + fraction * (ray.to - ray.from);
            visit({static_cast<std::int64_t>(std::floor(point.x())), 0,
                   static_cast<std::int64_t>(std::floor(point.z()))});
        }
    }

    float height;  // of the plane
};

/// The ray's shadow on the map, drawn cell by cell.
struct FlatRaster {
    static constexpr bool kIsFlat = true;

    template <class Visit>
    void walk(const Ray& ray, const Visit& visit) const {
        const auto onMap = [](const Vector3<float>& p) { return Vector3<float>(p.x(), 0, p.z()); };
        walkFaces(onMap(ray.from), onMap(ray.to), BorderTimes::multiplied, visit);
    }
};

struct FaceWalk {
    static constexpr bool kIsFlat = false;

    template <class Visit>
    void walk(const Ray& ray, const Visit& visit) const {
        walkFaces(ray.from, ray.to, times, visit);
    }

    BorderTimes times;
};

struct LayerWalk {
    static constexpr bool kIsFlat = false;

    template <class Visit>
    void walk(const Ray& ray, const Visit& visit) const {
        walkLayers(ray.from, ray.to, visit);
    }
};

template <class Walk>
std::unique_ptr<RayCaster> makeCaster(std::span<const Aabb<float>> boxes, const Walk& walk) {
    return std::make_unique<CellCaster<Walk>>(boxes, walk);
}

template <class Walk>
RayMethod walker(std::string name, const Walk& walk) {
    RayMethod method;
    method.name = std::move(name);
    method.walksCells = true;
    method.make = [walk](std::span<const Aabb<float>> boxes) { return makeCaster(boxes, walk); };
    return method;
}

// In the middle of all boxes: what the paper's ground is to a scene that is no ground.
RayMethod planePoint() {
    RayMethod method;
    method.name = "paper: point on the plane";
    method.make = [](std::span<const Aabb<float>> boxes) {
        Aabb<float> bounds;
        for (const Aabb<float>& box : boxes) {
            bounds.extend(box);
        }
        return makeCaster(boxes, PlanePoint{bounds.center().y()});
    };
    return method;
}

}  // namespace

std::vector<RayMethod> cellRayMethods() {
    std::vector<RayMethod> methods{planePoint(), walker("2D raster", FlatRaster{}),
                                   walker("DDA, accumulated", FaceWalk{BorderTimes::accumulated}),
                                   walker("DDA, multiplied", FaceWalk{BorderTimes::multiplied}),
                                   walker("DDA, conservative", LayerWalk{})};
    methods.back().mustFindAll = true;
    return methods;
}

}  // namespace hashphase::demos
