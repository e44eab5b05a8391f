// SPDX-License-Identifier: Zlib
#pragma once

// What `hashphase paper` measured, as tables.

#include <demos/paper/paper_results.hpp>
#include <demos/report/data_table.hpp>
#include <demos/report/graded_table.hpp>

#include <string>

namespace hashphase::demos {

/// By frames a second, the limits included: 60 or more, 20 or more.
[[nodiscard]] Grade gradeOf(std::optional<double> rate);

/// Of a printed rate, which stays a text; kNone for none.
[[nodiscard]] Grade gradeOfPrinted(std::string_view printed);

/// "1,234", "45", "0.3"; "-" for none.
[[nodiscard]] std::string rateText(std::optional<double> rate);

/// A printed rate as milliseconds a frame; of a censored one the bound, "<=16.7" or ">1000".
[[nodiscard]] std::string printedMilliseconds(std::string_view printed);

/// A figure: three rows for each number of objects, the paper's values, its methods today, and
/// hashphase; a column for each cell size. Graded by frames a second, of which it has the
/// milliseconds instead on request.
[[nodiscard]] GradedTable figureTable(const PaperResults& results, Phase phase,
                                      bool showMilliseconds);

/// Everything that was timed but the bounding volumes, a row for each method of each part.
[[nodiscard]] DataTable measurementRows(const PaperResults& results);

/// What of the figures was timed in fewer frames than the plan's, because it takes long.
[[nodiscard]] DataTable fewFramesTable(const PaperResults& results);

[[nodiscard]] DataTable radiusTable(const PaperResults& results);

/// Automatic cells have the size that was chosen.
[[nodiscard]] DataTable cellSizeTable(const PaperResults& results);
[[nodiscard]] DataTable volumeTable(const PaperResults& results);

}  // namespace hashphase::demos
