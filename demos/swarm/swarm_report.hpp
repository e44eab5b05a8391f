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

/// The first thing in which ranks and one process differ, in a sentence; empty where they agree.
[[nodiscard]] std::string differenceOf(const SwarmResult& result, const SingleResult& alone);

}  // namespace hashphase::demos
