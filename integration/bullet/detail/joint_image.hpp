// SPDX-License-Identifier: Zlib
#pragma once

// A joint's settings and impulses as bytes, and back: for WorldSnapshot.

#include <broadphase/core/byte_stream.hpp>
#include <integration/bullet/precision.hpp>

class btTypedConstraint;

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {

/// Whether it is of one of Bullet's types.
[[nodiscard]] bool isKnown(const btTypedConstraint& joint) noexcept;

/// Of a joint that is known.
void saveJoint(btTypedConstraint& joint, ByteWriter& to);
void restoreJoint(btTypedConstraint& joint, ByteReader& from);

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
