// SPDX-License-Identifier: Zlib
#pragma once

#include <vector>

namespace hashphase::demos {

/// The value below which `share` (0 to 1) of the sorted series lies, interpolated between
/// neighbours. The series must not be empty.
[[nodiscard]] double percentile(const std::vector<double>& sorted, double share);

}  // namespace hashphase::demos
