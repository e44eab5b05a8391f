// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/export.hpp>
#include <cstdint>
#include <optional>
#include <string>

namespace hashphase {

/// Settings of a grid. The defaults work for any scene. Change one only where a measurement of yours says so,
/// or to reproduce one.
struct GridConfig {
    /// Edge of the finest cells [m]. With 0 the grid chooses the cell sizes by the sizes of the proxies, and
    /// chooses again when the population changes. Valid: 0, or 1e-30 to 1e30.
    double cellSize = 0;

    /// With a fixed cell size, each coarser level's cells are this many times larger. Valid: 2 to 64.
    double levelRatio = 4;

    /// After this many updates without a change a proxy counts as resting, and later updates no
    /// longer touch it. Valid: 1 to 1,000,000.
    std::uint32_t updatesBeforeRest = 8;

    /// How far a proxy may move [m] from where it is filed before it is filed anew: boxes that tremble, or
    /// creep, cost less so. Answers are exact at all times. Empty: the grid follows the motion of each
    /// proxy. 0: not at all. Valid: 0 to 1e30.
    std::optional<double> slack{};

    friend bool operator==(const GridConfig&, const GridConfig&) = default;
};

/// Says what is wrong with `config` in a sentence that names the field and its valid range; empty
/// when all is well. Constructors that take a configuration throw std::invalid_argument with this sentence;
/// ask here first where exceptions are not wanted.
[[nodiscard]] HASHPHASE_BROADPHASE_EXPORT std::string configError(const GridConfig& config);

}  // namespace hashphase
