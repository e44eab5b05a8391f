// SPDX-License-Identifier: Zlib
#pragma once

// Checks the outer shape of a `.bullet` file. Bullet's importer trusts every count and length that
// it reads, so a truncated or damaged file would crash it.

#include <string>
#include <string_view>

namespace hashphase::demos {

/// Says what is wrong with the bytes of a `.bullet` file and at which byte; empty when the header is
/// one, every chunk lies within the file and fits its type, names end, the type table (DNA) is whole,
/// and at least one collision object is present. Cost: one pass.
[[nodiscard]] std::string bulletFileFault(std::string_view bytes);

/// What Bullet's importer passes over, in words: "1 multi-body and 2 soft bodies"; empty for nothing.
/// There must be no fault.
[[nodiscard]] std::string bulletFileOmissions(std::string_view bytes);

}  // namespace hashphase::demos
