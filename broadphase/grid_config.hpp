// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/export.hpp>
#include <cstdint>
#include <optional>
#include <string>

namespace hashphase {

/// Settings of a grid. The defaults suit any scene. Use other values only if you measured that they help, or to
/// reproduce an earlier measurement.
struct GridConfig {
    /// Edge [m] of the finest cells. If 0, the grid chooses cell sizes from the proxies' sizes, and chooses again
    /// when proxies change. Valid: 0, or 1e-30 to 1e30.
    double cellSize = 0;

    /// Factor from each cell size to the next coarser size. Used only if cellSize is not 0. Valid: 2 to 64.
    double levelRatio = 4;

    /// After this many updates without a change, a proxy can become resting. Updates skip resting proxies. Valid: 1
    /// to 1,000,000.
    std::uint32_t updatesBeforeRest = 8;

    /// How far [m] per axis a trembling or slow proxy may be from where it was sorted into a cell, before the grid
    /// sorts it again. Slack makes such proxies cheaper; results stay exact. If empty, the grid chooses a slack for
    /// each proxy from its motion. 0 means no slack. Valid: 0 to 1e30.
    std::optional<double> slack{};

    friend bool operator==(const GridConfig&, const GridConfig&) = default;
};

/// Returns a sentence that names the invalid field and its valid range; empty for a valid configuration. Constructors
/// that receive an invalid GridConfig throw std::invalid_argument with this sentence. To avoid exceptions, call
/// configError() first.
[[nodiscard]] HASHPHASE_BROADPHASE_EXPORT std::string configError(const GridConfig& config);

}  // namespace hashphase
