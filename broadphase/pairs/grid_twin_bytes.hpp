// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/pairs/grid_twin.hpp>

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace hashphase::detail {

/// See GridSnapshot::write().
template <class Scalar>
void writeTwin(const GridTwin<Scalar>& twin, std::vector<std::byte>& bytes);

/// See GridSnapshot::read().
template <class Scalar>
[[nodiscard]] std::string readTwin(std::span<const std::byte> bytes,
                                   std::unique_ptr<GridTwin<Scalar>>& twin);

}  // namespace hashphase::detail
