// SPDX-License-Identifier: Zlib
#pragma once

// A chart as Vega-Lite draws it: https://vega.github.io/vega-lite/

#include <demos/report/chart.hpp>
#include <demos/report/json_values.hpp>
#include <demos/report/series_looks.hpp>

#include <array>
#include <string>

namespace hashphase::demos {

/// Colours as CSS has them.
struct ChartTheme {
    std::string ink;         // texts, axes, what belongs to no series
    std::string faint;       // grid lines
    std::string background;  // empty: none
    std::array<std::string, kSeriesColours> series;
};

/// For pictures: dark on white.
[[nodiscard]] const ChartTheme& pictureTheme();

/// For pages: variables that the page's style sheet sets, for a light or a dark screen or for paper.
[[nodiscard]] const ChartTheme& pageTheme();

enum class ChartTitle { kNone, kInside };

/// The chart with its data. A logarithmic axis with 0 has it apart, below the smallest number, where
/// it is labelled 0. Series without a look get the first.
[[nodiscard]] Json vegaLiteSpec(const Chart& chart, const SeriesLooks& looks,
                                const ChartTheme& theme, ChartTitle title);

}  // namespace hashphase::demos
