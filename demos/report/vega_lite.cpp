// SPDX-License-Identifier: Zlib
#include <demos/report/vega_lite.hpp>

#include <demos/report/chart_drawing.hpp>

#include <algorithm>
#include <utility>

namespace hashphase::demos {
namespace {

constexpr std::size_t kLettersOfATitle = 84;  // that fit into the width of a chart, in bold
constexpr std::size_t kLettersOfASubtitle = 105;

/// The text in lines of at most so many letters.
Json lines(const std::string& text, std::size_t width) {
    Json all = Json::array();
    std::string line;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find(' ', begin), text.size());
        const std::string word = text.substr(begin, end - begin);
        if (!line.empty() && line.size() + 1 + word.size() > width) {
            all.push_back(std::exchange(line, {}));
        }
        line += (line.empty() ? "" : " ") + word;
        begin = end + 1;
    }
    all.push_back(line);
    return all;
}

Json configOf(const ChartTheme& theme) {
    const Json texts{{"labelColor", theme.ink},     {"titleColor", theme.ink},
                     {"labelFontSize", 12},         {"titleFontSize", 13},
                     {"titleFontWeight", "normal"}, {"labelLimit", 0}};
    Json axis = texts;
    axis.update({{"gridColor", theme.faint},
                 {"domainColor", theme.ink},
                 {"tickColor", theme.ink},
                 {"titlePadding", 8},
                 {"maxExtent", 400},
                 {"tickCount", 8},
                 {"labelOverlap", true}});
    Json legend = texts;
    legend.update({{"orient", "bottom"},
                   {"direction", "horizontal"},
                   {"symbolSize", 90},
                   {"columnPadding", 18},
                   {"titleLimit", 0},
                   {"gradientLength", 300},
                   {"offset", 14},
                   {"layout", {{"bottom", {{"anchor", "start"}, {"direction", "vertical"}}}}}});
    return {{"font", "system-ui, sans-serif"},
            {"background", theme.background.empty() ? Json(nullptr) : Json(theme.background)},
            {"padding", theme.background.empty() ? 2 : 14},
            {"axis", std::move(axis)},
            {"legend", std::move(legend)},
            {"view", {{"stroke", nullptr}}},
            {"title",
             {{"anchor", "start"},
              {"frame", "bounds"},
              {"color", theme.ink},
              {"subtitleColor", theme.ink},
              {"fontSize", 15},
              {"subtitleFontSize", 12},
              {"subtitlePadding", 6},
              {"offset", 16}}}};
}

}  // namespace

Json vegaLiteSpec(const Chart& chart, const SeriesLooks& looks, const ChartTheme& theme,
                  ChartTitle title) {
    const detail::ChartDrawing drawing(chart, looks, theme);
    Json spec{{"$schema", "https://vega.github.io/schema/vega-lite/v6.json"},
              {"description", chart.title}};
    if (title == ChartTitle::kInside) {
        spec["title"] = {{"text", lines(chart.title, kLettersOfATitle)},
                         {"subtitle", lines(chart.settings, kLettersOfASubtitle)}};
    }
    spec["width"] = drawing.width();
    spec["height"] = drawing.height();
    spec["data"] = {{"values", drawing.values()}};
    spec["encoding"] = drawing.encoding();
    spec["layer"] = drawing.layers();
    spec["config"] = configOf(theme);
    return spec;
}

}  // namespace hashphase::demos
