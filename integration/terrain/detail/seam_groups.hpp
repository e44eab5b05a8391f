// SPDX-License-Identifier: Zlib
#pragma once

// How large the numbers were by which the corners of the present triangles were computed: by as much rounding
// may have moved them. Triangles are counted in groups of about the same numbers, and forgotten when the last of
// a group leaves, so that what has left decides nothing.

#include <broadphase/core/ensure_capacity.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::detail {

template <class Scalar>
class SeamGroups {
public:
    /// An extent [m] counts as the next power of two, from the smallest to the largest: a stray corner makes no
    /// tolerance of 1e30 m.
    static constexpr double kSmallest = 1.0 / 1024;
    static constexpr double kLargest = 16384;
    /// Groups; the last one takes whatever the others have no room for.
    static constexpr std::size_t kMost = 256;

    /// Makes room for a group, which add() takes.
    void reserveOne() {
        ensureCapacity(groups_, std::min(groups_.size() + 1, kMost));
        ensureCapacity(origins_, groups_.capacity());
    }

    /// Counts triangles of a mesh of this extent [m]. Returns their group.
    [[nodiscard]] std::uint8_t add(double extent, std::uint32_t count) noexcept {
        const Group added{roundedUp(extent), {}, 0};
        auto group = std::find_if(groups_.begin(), groups_.end(),
                                  [&](const Group& other) { return other.isLike(added); });
        if (group == groups_.end()) {
            group = std::find_if(groups_.begin(), groups_.end(),
                                 [](const Group& other) { return other.count == 0; });
            if (group != groups_.end()) {
                *group = added;
            } else if (groups_.size() < kMost) {
                groups_.push_back(added);
                group = groups_.end() - 1;
            } else {
                --group;
                group->extent = std::max(group->extent, added.extent);
            }
        }
        group->count += count;
        extent_ = std::max(extent_, group->extent);
        return static_cast<std::uint8_t>(group - groups_.begin());
    }

    /// A triangle of the group leaves.
    void remove(std::uint8_t group) noexcept {
        if (--groups_[group].count == 0) {
            summarise();
        }
    }

    /// The origin is shifted by so much along the ground [m].
    void shiftOrigin(Scalar x, Scalar z) noexcept {
        for (std::size_t i = 0; i < groups_.size(); ++i) {
            Group& group = groups_[i];
            if (i + 1 == kMost) {  // of any shifts: none is farther than this
                group.extent += std::max(std::abs(x), std::abs(z));
            } else {
                group.origins.shift(x, z);
            }
        }
        summarise();
    }

    void clear() noexcept {
        groups_.clear();
        summarise();
    }

    /// The largest extent of a mesh with a triangle left [m]; 0 without triangles.
    [[nodiscard]] Scalar extent() const noexcept { return extent_; }

    /// The larger coordinate of the point [m], of all origins since a triangle came that is left.
    [[nodiscard]] Scalar farthest(Scalar x, Scalar z) const noexcept {
        Scalar result = std::max(std::abs(x), std::abs(z));
        for (const Origins& origins : origins_) {
            result = std::max({result, std::abs(x + origins.lowX), std::abs(x + origins.highX),
                               std::abs(z + origins.lowZ), std::abs(z + origins.highZ)});
        }
        return result;
    }

    [[nodiscard]] std::size_t size() const noexcept { return groups_.size(); }
    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return groups_.capacity() * sizeof(Group) + origins_.capacity() * sizeof(Origins);
    }

private:
    /// By how much coordinates were larger than they are, at each origin since the triangles came: a shift
    /// rounds as coarsely as its coordinates are large, and a later one back does not undo it.
    struct Origins {
        Scalar lowX = 0;  // 0 or less: the present origin is one of them
        Scalar lowZ = 0;
        Scalar highX = 0;
        Scalar highZ = 0;

        void shift(Scalar x, Scalar z) noexcept {
            lowX = std::min(lowX + x, Scalar(0));
            lowZ = std::min(lowZ + z, Scalar(0));
            highX = std::max(highX + x, Scalar(0));
            highZ = std::max(highZ + z, Scalar(0));
        }
        friend bool operator==(const Origins&, const Origins&) = default;
    };
    struct Group {
        Scalar extent;
        Origins origins;
        std::uint32_t count;  // of triangles; 0 where the place is free

        [[nodiscard]] bool isLike(const Group& other) const noexcept {
            return count > 0 && extent == other.extent && origins == other.origins;
        }
    };

    static Scalar roundedUp(double extent) noexcept {
        int exponent = 0;
        const double share = std::frexp(std::clamp(extent, kSmallest, kLargest), &exponent);
        return static_cast<Scalar>(std::ldexp(1.0, share == 0.5 ? exponent - 1 : exponent));
    }

    // What is asked of all groups, at hand.
    void summarise() noexcept {
        extent_ = 0;
        origins_.clear();
        for (const Group& group : groups_) {
            if (group.count == 0) {
                continue;
            }
            extent_ = std::max(extent_, group.extent);
            if (group.origins != Origins{} &&
                std::find(origins_.begin(), origins_.end(), group.origins) == origins_.end()) {
                origins_.push_back(group.origins);
            }
        }
    }

    std::vector<Group> groups_;
    std::vector<Origins> origins_;  // of the groups, those that are not 0, each once
    Scalar extent_ = 0;
};

}  // namespace hashphase::detail

#include <broadphase/core/restore_macros.hpp>
