// SPDX-License-Identifier: Zlib
#pragma once

// What a swarm's ranks have done, as people read it.

#include <demos/report/data_table.hpp>
#include <demos/swarm/swarm_run.hpp>

#include <iosfwd>
#include <optional>

namespace hashphase::demos {

/// Medians over the frames but the first, a row for each rank.
[[nodiscard]] DataTable ranksTable(const SwarmResult& result);

/// A row for each frame and rank.
[[nodiscard]] DataTable framesTable(const SwarmResult& result);

/// Says how evenly work was shared, what was sent, and how fast it was.
void printSwarm(const SwarmResult& result, const std::optional<SingleResult>& alone,
                std::ostream& out);

/// Says whether ranks and one process agree, or that these are not compared. False if they differ, or if one process
/// has failed.
[[nodiscard]] bool printComparison(const SwarmResult& result, const SingleRun& alone,
                                   std::ostream& out);

}  // namespace hashphase::demos
