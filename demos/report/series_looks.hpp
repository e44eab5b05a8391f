// SPDX-License-Identifier: Zlib
#pragma once

// How each method looks in all charts of a page: always the same colour and shape of points.

#include <demos/report/chart.hpp>

#include <array>
#include <map>
#include <span>
#include <string>

namespace hashphase::demos {

inline constexpr std::size_t kSeriesColours = 7;

/// The shapes of points as Vega names them, in the order of SeriesLook::shape.
inline constexpr std::array kSeriesShapes{"circle",  "square", "triangle-up",
                                          "diamond", "cross",  "triangle-down"};

struct SeriesLook {
    std::size_t colour = 0;  // below kSeriesColours
    std::size_t shape = 0;   // below kSeriesShapes.size()
};

using SeriesLooks = std::map<std::string, SeriesLook, std::less<>>;

/// A look for every series of the charts. Those that share a chart differ in colour as long as there
/// are colours, and then in shape.
[[nodiscard]] SeriesLooks seriesLooks(std::span<const Chart* const> charts);

/// The names of the series of a chart in the order of its rows; none where it has one series.
[[nodiscard]] std::vector<std::string> seriesOf(const Chart& chart);

}  // namespace hashphase::demos
