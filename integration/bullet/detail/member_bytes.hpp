// SPDX-License-Identifier: Zlib
#pragma once

// Members of Bullet's objects as bytes, and back, for all of whose classes there is a forEachMember(owner, visit).

#include <broadphase/core/byte_stream.hpp>
#include <integration/bullet/precision.hpp>

#include <LinearMath/btTransform.h>

#include <cstddef>
#include <cstring>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {

/// Calls copy(member, bytes) for a member of a kind, or for its parts: of vectors no more than there is in them.
template <class Copy>
struct ByParts {
    Copy copy;

    template <PlainNumber Number>
    void operator()(Number& number) const {
        copy(&number, sizeof(number));
    }
    void operator()(btVector3& vector) const { copy(vector.m_floats, 3 * sizeof(btScalar)); }
    void operator()(btQuaternion& rotation) const { copy(&rotation[0], 4 * sizeof(btScalar)); }
    void operator()(btMatrix3x3& matrix) const {
        for (int row = 0; row < 3; ++row) {
            (*this)(matrix[row]);
        }
    }
    void operator()(btTransform& place) const {
        (*this)(place.getBasis());
        (*this)(place.getOrigin());
    }
};

// More than the members of any object or world have together.
inline constexpr std::size_t kMostMemberBytes = 4096;

// Writes the members of an object, a world or a character.
void saveMembers(auto& owner, ByteWriter& to) {
    to.writeBlock(kMostMemberBytes, [&](std::byte* at) {
        const auto save = [&at](const void* member, std::size_t count) {
            std::memcpy(at, member, count);
            at += count;
        };
        forEachMember(owner, ByParts<decltype(save)>{save});
        return at;
    });
}

void restoreMembers(auto& owner, ByteReader& from) {
    const std::byte* at = from.rest().data();
    const auto restore = [&at](void* member, std::size_t count) {
        std::memcpy(member, at, count);
        at += count;
    };
    forEachMember(owner, ByParts<decltype(restore)>{restore});
    from.skip(static_cast<std::size_t>(at - from.rest().data()));
}

/// How many bytes saveMembers() writes.
[[nodiscard]] std::size_t bytesOf(auto& owner) {
    std::size_t bytes = 0;
    const auto count = [&bytes](const void* /*member*/, std::size_t size) { bytes += size; };
    forEachMember(owner, ByParts<decltype(count)>{count});
    return bytes;
}

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
