// SPDX-License-Identifier: Zlib
#pragma once

// Scenes for rays whose truth can be known exactly: all coordinates lie on the lattice of
// exact_entry.hpp.

#include <demos/accuracy/picking/picking_experiment.hpp>
#include <demos/scenes/random.hpp>

#include <array>
#include <string_view>
#include <vector>

namespace hashphase::demos {

/// Boxes of up to 1 m in a slab whose coordinates lie between 1024 and 2048 m, where a step of the
/// lattice is the last bit of a float (an ulp). Half of them have their corners on corners of
/// cells.
[[nodiscard]] std::vector<Aabb<float>> slabOfBoxes(std::size_t count, std::uint64_t seed);

/// What of a box a ray comes near.
enum class Contact : std::uint8_t { face, edge, corner };
inline constexpr std::array kContacts{Contact::face, Contact::edge, Contact::corner};
[[nodiscard]] std::string_view nameOf(Contact contact);

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
