// SPDX-License-Identifier: Zlib
#pragma once

// What to choose, by what one can afford.

#include <demos/accuracy/experiment.hpp>
#include <demos/report/data_table.hpp>

#include <span>
#include <vector>

namespace hashphase::demos {

/// The choices that no other one of the same task beats in both time and error, task by task in the
/// given order, the fastest first. Of equals the first stays.
[[nodiscard]] std::vector<Choice> paretoFront(std::span<const Choice> choices);

/// "If you can afford x ms, use ..., and you get ...": a row for each choice on the front.
[[nodiscard]] DataTable adviceTable(std::span<const Choice> choices);

}  // namespace hashphase::demos
