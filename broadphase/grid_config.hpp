// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/export.hpp>
#include <cstdint>
#include <optional>
#include <string>

namespace hashphase {

/// Settings of a grid. The defaults suit any scene. Change one only after your own measurement, or to reproduce one.
struct GridConfig {
    /// Edge of the finest cells [m]. 0: the grid chooses cell sizes from the proxies' sizes, and again when the
    /// population changes. Valid: 0, or 1e-30 to 1e30.
    double cellSize = 0;

    /// Ratio of cell sizes from one level to the next coarser one, for a fixed cell size. Valid: 2 to 64.
    double levelRatio = 4;

    /// A proxy rests after this many updates without a change; later updates no longer touch it. Valid: 1 to
    /// 1,000,000.
    std::uint32_t updatesBeforeRest = 8;

    /// How far [m] a proxy may move from where it is filed before it is filed again. Trembling or creeping boxes then
    /// cost less; answers stay exact. Empty: follows the motion of each proxy. 0: off. Valid: 0 to 1e30.
    std::optional<double> slack{};

    friend bool operator==(const GridConfig&, const GridConfig&) = default;
};

/// Returns a sentence that names the invalid field and its valid range; empty for a valid configuration. Constructors
/// throw std::invalid_argument with this sentence; check here first to avoid exceptions.
[[nodiscard]] HASHPHASE_BROADPHASE_EXPORT std::string configError(const GridConfig& config);

}  // namespace hashphase
