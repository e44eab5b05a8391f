// SPDX-License-Identifier: Zlib
#pragma once

// What random operations are played on. The first bit of the first operation's kind chooses the
// precision, but for Bullet's, which are compiled for either.

#include <tests/fuzz/operation.hpp>

namespace hashphase::test {

/// The grid: changes, updates, and every query but those of pairs.
Verdict playGrid(std::span<const Operation> operations, bool tellsStory);
inline constexpr Subject kGrid{"grid", &playGrid};

/// Pairs and sweeps over a grid, with a filter that changes its mind.
Verdict playPairs(std::span<const Operation> operations, bool tellsStory);
inline constexpr Subject kPairs{"pairs", &playPairs};

/// Picking, culling, zones, radar, sight and terrain over one grid.
Verdict playClients(std::span<const Operation> operations, bool tellsStory);
inline constexpr Subject kClients{"clients", &playClients};

/// SpatialHashBroadphase with its queries and batches, over several pair caches; and PairCache
/// under btDbvtBroadphase.
Verdict playBroadphase(std::span<const Operation> operations, bool tellsStory);
inline constexpr Subject kBroadphase{"broadphase", &playBroadphase};

/// PairCache by itself.
Verdict playCache(std::span<const Operation> operations, bool tellsStory);
inline constexpr Subject kCache{"cache", &playCache};

/// The readers of recordings, of boxes as text and of the outer shape of .bullet files.
Verdict playFiles(std::span<const Operation> operations, bool tellsStory);
inline constexpr Subject kFiles{"files", &playFiles};

}  // namespace hashphase::test
