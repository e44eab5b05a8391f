// SPDX-License-Identifier: Zlib
#pragma once

// P5: ways to find the boxes that a ray meets, and how much is measured of them.

#include <broadphase/aabb.hpp>
#include <demos/accuracy/experiment.hpp>
#include <demos/scenes/random.hpp>

#include <array>

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

/// A method that has filed a scene: appends each box that it finds, once.
using RayCaster = std::function<RayCost(const Ray&, std::vector<RayHit>&)>;

/// must_find_all  a box that is hit and not found breaks a check
/// nearest_only   finds no other
/// walks_cells    takes time for each cell of a long ray
using RayMethod = Method<RayCaster(std::span<const Aabb<float>>)>;

/// Through plain cells of 1 m, the paper's first; the library's; Bullet's.
[[nodiscard]] std::vector<RayMethod> rayMethods();

/// How much is measured.
struct PickingPlan {
    std::size_t boxes;  // in the slab
    int graze;          // rays for each contact and offset
    int frames;         // that are timed
    std::size_t raysPerFrame;
    std::size_t strungBoxes;  // along all long rays of one length
    int longestPower;         // of ten: the longest ray [m], and so about as many cells
    double metresInAll;       // of the long rays of one length, if there is more than one
    double longestCellWalk;   // of methods that take time for each cell [m]
};

/// Measures, and says what it shows (picking.sql).
[[nodiscard]] Findings findPicking(const PickingPlan& plan, std::uint64_t seed,
                                   std::span<const RayMethod> methods, const TellProgress& tell);

// --- Scenes whose truth can be known exactly: all coordinates lie on the lattice of exact_entry.hpp ----

/// Boxes of up to 1 m in a slab whose coordinates lie between 1024 and 2048 m, where a step of the
/// lattice is the last bit of a float (an ulp). Half of them have their corners on corners of
/// cells.
[[nodiscard]] std::vector<Aabb<float>> slabOfBoxes(std::size_t count, std::uint64_t seed);

/// What of a box a ray comes near.
enum class Contact : std::uint8_t { face, edge, corner };
inline constexpr std::array kContacts{Contact::face, Contact::edge, Contact::corner};

/// A ray of some 10 to 700 m that passes the box at exactly that distance from the box: `ulps`
/// steps of the lattice outside or, negative, inside. At 0 it touches a face along its way, an edge
/// or a corner in one point. Half of the rays run through space along diagonals of cells.
[[nodiscard]] Ray grazingRay(const Aabb<float>& box, Contact contact, int ulps, Random& random);

/// Rays from near the origin that are so many metres long, and boxes strung along each, of which it
/// meets about half. A box is a metre large, or an ulp of its coordinates where that is more.
struct StrungBoxes {
    std::vector<Ray> rays;
    std::vector<Aabb<float>> boxes;
};
[[nodiscard]] StrungBoxes strungBoxes(double length, std::size_t rays, std::size_t boxes,
                                      std::uint64_t seed);

}  // namespace hashphase::demos
