// SPDX-License-Identifier: Zlib
#include <demos/accuracy/picking/picking_experiment.hpp>

#include <demos/accuracy/exact_entry.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hashphase::demos {
namespace {

// The slab keeps so far away from 1024 and 2048 m that no ray leaves them.
constexpr float kLow = 1400;
constexpr float kHigh = 1700;
constexpr float kFloor = 1500;
constexpr float kCeiling = 1516;

float roundedToLattice(float coordinate) {
    return std::floor(coordinate / kLattice) * kLattice;
}

bool tossed(Random& random) {
    return random.unit() < 0.5F;
}

// Not 0; a whole or half metre where the ray is to run through corners of cells.
float stride(Random& random, bool isDiagonal) {
    const float size = isDiagonal ? (tossed(random) ? 0.5F : 1)
                                  : kLattice + roundedToLattice(random.between(0, 1));
    return tossed(random) ? size : -size;
}

float within(const Aabb<float>& box, int axis, Random& random) {
    return roundedToLattice(random.between(box.min()[axis], box.max()[axis]));
}

}  // namespace

std::vector<Aabb<float>> slabOfBoxes(std::size_t count, std::uint64_t seed) {
    Random random(seed);
    std::vector<Aabb<float>> boxes;
    for (std::size_t i = 0; i < count; ++i) {
        const bool isAligned = i % 2 == 0;
        const auto place = [&](float low, float high) {
            const float number = random.between(low, high);
            return isAligned ? std::floor(number) : roundedToLattice(number);
        };
        const Vector3<float> low{place(kLow, kHigh), place(kFloor, kCeiling), place(kLow, kHigh)};
        const auto edge = [&] {
            return isAligned ? 1 : roundedToLattice(random.between(0.25F, 1));
        };
        const Vector3<float> size{edge(), edge(), edge()};
        boxes.emplace_back(low, low + size);
    }
    return boxes;
}

Ray grazingRay(const Aabb<float>& box, Contact contact, int ulps, Random& random) {
    const bool isDiagonal = tossed(random);
    const int first = static_cast<int>(random.between(0, 3));
    const int turn = tossed(random) ? 1 : 2;
    const std::array<int, 3> axes{first, (first + turn) % 3, (first + 2 * turn) % 3};
    Vector3<float> point;
    Vector3<float> way;
    Vector3<float> outward;
    for (const int axis : axes) {
        const bool isHigh = tossed(random);
        outward[axis] = isHigh ? 1.0F : -1.0F;
        point[axis] = (isHigh ? box.max() : box.min())[axis];
        way[axis] = stride(random, isDiagonal);
    }
    point[axes[0]] += outward[axes[0]] * kLattice * static_cast<float>(ulps);
    if (contact == Contact::face) {
        way[axes[0]] = 0;
        point[axes[1]] = within(box, axes[1], random);
    } else {
        // Out along one axis where it comes in along the other, so that it meets the box nowhere else.
        way[axes[0]] = std::copysign(way[axes[0]], outward[axes[0]]);
        way[axes[1]] = std::copysign(way[axes[1]], -outward[axes[1]]);
    }
    if (contact != Contact::corner) {
        point[axes[2]] = within(box, axes[2], random);
    }
    const auto steps = [&] { return std::floor(random.between(10, 250)); };
    return {point - steps() * way, point + steps() * way};
}

StrungBoxes strungBoxes(double length, std::size_t rays, std::size_t boxes, std::uint64_t seed) {
    Random random(seed);
    StrungBoxes scene;
    for (std::size_t i = 0; i < rays; ++i) {
        Ray ray;
        Vector3<double> way;
        for (int axis = 0; axis < 3; ++axis) {
            ray.from[axis] = roundedToLattice(random.between(1, 2));
            way[axis] = static_cast<double>(random.between(0.1F, 1));
        }
        const Vector3<double> from = ray.from.cast<double>();
        way *= length / way.norm();
        for (int axis = 0; axis < 3; ++axis) {
            ray.to[axis] = roundedToLattice(static_cast<float>(from[axis] + way[axis]));
        }
        scene.rays.push_back(ray);
        for (std::size_t k = 0; k < boxes; ++k) {
            const Vector3<double> point = from + static_cast<double>(random.unit()) * way;
            const float farthest = static_cast<float>(point.maxCoeff());
            const float ulp =
                std::nextafter(farthest, std::numeric_limits<float>::infinity()) - farthest;
            const float size = std::max(1.0F, ulp);
            Aabb<float> box;
            for (int axis = 0; axis < 3; ++axis) {
                const auto offset = static_cast<double>(size * random.between(-1.2F, 0.2F));
                box.min()[axis] = roundedToLattice(static_cast<float>(point[axis] + offset));
                box.max()[axis] = roundedToLattice(box.min()[axis] + size);
            }
            scene.boxes.push_back(box);
        }
    }
    return scene;
}

}  // namespace hashphase::demos
