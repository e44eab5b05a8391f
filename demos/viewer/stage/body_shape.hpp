// SPDX-License-Identifier: Zlib
#pragma once

// Where a body is, by its shape, and where the ground is.

#include <demos/viewer/stage/stage.hpp>

#include <optional>
#include <span>

namespace hashphase::demos {

/// Where the way from a point first meets the body, as a share of the way: 0 where it begins inside, nothing
/// where it does not.
[[nodiscard]] std::optional<float> meets(const StageBody& body, const Vector3<float>& from,
                                         const Vector3<float>& way);

/// The same of triangles, three corners each, from either side. Cost: O(triangles).
[[nodiscard]] std::optional<float> meets(std::span<const Vector3<float>> triangles,
                                         const Vector3<float>& from, const Vector3<float>& way);

/// The box around it.
[[nodiscard]] Aabb<float> boxAround(const StageBody& body);

}  // namespace hashphase::demos
