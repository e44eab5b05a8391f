// SPDX-License-Identifier: Zlib
#pragma once

// Ways to know, frame by frame, which boxes overlap.

#include <demos/compare/filled_broadphase.hpp>

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {

/// One way at work on one scene.
class PairSource {
public:
    PairSource() = default;
    PairSource(const PairSource&) = delete;
    PairSource& operator=(const PairSource&) = delete;
    virtual ~PairSource() = default;

    /// A frame: takes the boxes as they are now, and finds the pairs.
    virtual void step(std::span<const BulletBox> boxes) = 0;

    /// Replaces `pairs` by those that the last step left, sorted.
    virtual void listPairs(std::vector<PairKey>& pairs) const = 0;

    /// How many times the last step compared two boxes, where that is counted.
    [[nodiscard]] virtual std::optional<std::uint64_t> boxesTested() const { return std::nullopt; }
};

/// Whose a method is.
inline constexpr std::string_view kOurs = "ours";
inline constexpr std::string_view kOfPaper = "paper";
inline constexpr std::string_view kOfBullet = "bullet";

struct PairMethod {
    std::string name;
    std::string_view origin = kOurs;
    bool isExact = true;                // promises the overlapping pairs, all of them and no other
    bool isComplete = true;             // promises all of them, perhaps with others
    std::optional<double> factor = {};  // cell size by mean edge, where somebody has that choice

    /// When it compares more boxes than this in a frame, it is judged, but not timed.
    double mostTestsTimed = std::numeric_limits<double>::infinity();

    std::function<std::unique_ptr<PairSource>(const BroadphaseNeeds& needs,
                                              std::span<const BulletBox> boxes)>
        make;
};

/// SpatialHashBroadphase, its pair cache included.
[[nodiscard]] PairMethod hashMethod(std::string name, const GridConfig& grid = {});

/// btDbvtBroadphase, with m_deferedcollide or without.
[[nodiscard]] PairMethod dbvtMethod(bool isDeferred);

/// Whether the closed boxes share a point.
[[nodiscard]] inline bool overlap(const BulletBox& a, const BulletBox& b) {
    bool isApart = false;
    for (int axis = 0; axis < 3; ++axis) {
        isApart |= (a.min[axis] > b.max[axis]) | (b.min[axis] > a.max[axis]);
    }
    return !isApart;
}

/// The kind of broadphase of that name; asserted to exist.
[[nodiscard]] const BroadphaseKind& broadphaseKind(std::string_view name);

}  // namespace hashphase::demos
