// SPDX-License-Identifier: Zlib
#pragma once

// How each series looks in all charts of a page: always the same colour, shape of points, and dash.
//
// A series is named "method", or "method, variant": "paper's grid, cells of 5 m". All that is of one
// method has one colour; its variants differ in shape and dash.

#include <demos/report/chart.hpp>

#include <array>
#include <map>
#include <span>
#include <string>
#include <string_view>

namespace hashphase::demos {

inline constexpr std::size_t kSeriesColours = 7;

/// The shapes of points as Vega names them, in the order of SeriesLook::shape.
inline constexpr std::array kSeriesShapes{"circle",  "square", "triangle-up",
                                          "diamond", "cross",  "triangle-down"};

struct SeriesLook {
    std::size_t colour = 0;  // below kSeriesColours
    std::size_t shape = 0;   // below kSeriesShapes.size()
    std::size_t dash = 0;    // 0 for the first variant of a method, a full line
};

using SeriesLooks = std::map<std::string, SeriesLook, std::less<>>;

/// The part of a series' name before its variant.
[[nodiscard]] std::string_view methodOf(std::string_view series);

/// A look for every series of the charts. Methods that share a chart differ in colour as long as there
/// are colours; series of one colour in a chart differ in shape as long as there are shapes.
[[nodiscard]] SeriesLooks seriesLooks(std::span<const Chart* const> charts);

/// The names of the series of a chart in the order of its rows; none where it has one series.
[[nodiscard]] std::vector<std::string> seriesOf(const Chart& chart);

}  // namespace hashphase::demos
