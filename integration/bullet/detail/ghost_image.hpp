// SPDX-License-Identifier: Zlib
#pragma once

// The pairs that ghosts keep of their own, with their algorithms: for WorldSnapshot.

#include <integration/bullet/detail/broadphase_image.hpp>
#include <integration/bullet/detail/contact_image.hpp>
#include <integration/bullet/precision.hpp>

#include <BulletCollision/CollisionDispatch/btGhostObject.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {

class GhostImage {
public:
    void begin() { pairs_.clear(); }
    /// Adds the pairs of a ghost, and their contacts. Returns how many pairs there are.
    int save(btPairCachingGhostObject& ghost, ContactImage& contacts);

    /// Begins to restore. Of each ghost that is there, detach() is called as long as proxies are what they are
    /// now; then endDetach(), and restore() for each of the saved ones, in their order, once proxies are what they
    /// were.
    void beginRestore() const {
        detached_.clear();
        at_ = 0;
    }
    void makeRoom(std::size_t pairCount) const;
    void detach(btPairCachingGhostObject& ghost) const;
    void endDetach() const;
    void restore(btPairCachingGhostObject& ghost, int pairCount,
                 const SpatialHashBroadphase& broadphase, const ContactImage& contacts,
                 btCollisionDispatcher& dispatcher) const;
    /// Frees the algorithms that were detached of the pairs of these clients.
    void freeAlgorithmsOf(const ObjectNumbers& clients, btCollisionDispatcher& dispatcher) const;
    /// Frees the algorithms of pairs that are not there any more.
    void endRestore(btCollisionDispatcher& dispatcher) const;

    void write(ByteWriter& to) const;
    /// Returns whether what was read are pairs of two different proxies.
    [[nodiscard]] bool read(ByteReader& from, const BroadphaseImage& broadphase);
    [[nodiscard]] std::span<const BroadphaseImage::Pair> pairs() const noexcept { return pairs_; }

    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return sizeof(*this) + pairs_.capacity() * sizeof(pairs_[0]) +
               detached_.capacity() * sizeof(detached_[0]);
    }

private:
    using Pair = BroadphaseImage::Pair;
    /// An algorithm, and where it was.
    struct Detached {
        std::array<const void*, 3> place;  // the ghost, and the two clients
        btCollisionAlgorithm* algorithm;

        [[nodiscard]] bool isBefore(const std::array<const void*, 3>& other) const noexcept {
            return std::ranges::lexicographical_compare(place, other, std::less<>());
        }
    };

    std::vector<Pair> pairs_;
    mutable std::vector<Detached> detached_;  // by place, once all are
    mutable std::size_t at_ = 0;              // in pairs_
};

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
