// SPDX-License-Identifier: Zlib
#include <demos/report/chart_drawing.hpp>

#include <demos/report/chart_front.hpp>

#include <algorithm>
#include <map>
#include <set>

namespace hashphase::demos::detail {
namespace {

constexpr std::size_t kPointsOfAClearLine = 40;  // more of them are drawn small
constexpr int kPointSize = 60;                   // [px squared]
constexpr int kSmallPointSize = 12;

Json datumField(const char* field) {
    return {{"expr", std::string("datum['") + field + "']"}};
}

Json datumTest(const char* field) {
    return std::string("datum['") + field + "']";
}

Json filter(const std::string& test) {
    return Json::array({Json{{"filter", test}}});
}

Json inlineData(Json values) {
    return {{"values", std::move(values)}};
}

}  // namespace

Json ChartDrawing::layers() const {
    Json layers = Json::array();
    addGapLayers(layers);
    if (chart_.showFront) {
        layers.push_back(frontLayer());
    }
    switch (chart_.mark) {
        case ChartMark::kCell:
            addCellLayers(layers);
            break;
        case ChartMark::kBar:
            layers.push_back(barLayer());
            break;
        case ChartMark::kLine:
            layers.push_back(lineLayer());
            break;
        case ChartMark::kPoint:
            break;
    }
    if (!chart_.low.empty()) {
        layers.push_back(errorLayer());
    }
    if (!chart_.theory.empty()) {
        layers.push_back(theoryLayer());
    }
    if (chart_.mark == ChartMark::kLine || chart_.mark == ChartMark::kPoint) {
        layers.push_back(pointLayer());
    }
    if (!chart_.label.empty()) {
        layers.push_back(labelLayer());
    }
    return layers;
}

// A dotted line between the numbers and 0, which a logarithmic axis does not reach.
void ChartDrawing::addGapLayers(Json& layers) const {
    const auto add = [&](const ChartAxis& axis, const char* field, const std::string& across) {
        if (axis.gap()) {
            layers.push_back({{"data", inlineData(Json::array({Json{{field, *axis.gap()}}}))},
                              {"mark",
                               {{"type", "rule"},
                                {"color", theme_.ink},
                                {"strokeDash", {1, 3}},
                                {"opacity", 0.7}}},
                              {"encoding", {{across, nullptr}, {across + "Offset", nullptr}}}});
        }
    };
    add(x_, field::kX, valueChannel());
    add(y_, field::kY, nameChannel());
}

void ChartDrawing::addCellLayers(Json& layers) const {
    layers.push_back(
        {{"mark", {{"type", "rect"}}},
         {"encoding", {{"color", shade_->colourEncoding(field::kShade)}, {"tooltip", tooltip()}}}});
    layers.push_back(
        {{"transform", filter(std::string("isValid(datum['") + field::kShade + "'])")},
         {"mark", {{"type", "text"}, {"fontSize", 11}}},
         {"encoding",
          {{"text", {{"field", field::kShadeText}, {"type", "nominal"}}},
           {"color",
            {{"condition", {{"test", datumTest(field::kIsBright)}, {"value", "#000000"}}},
             {"value", "#ffffff"}}}}}});
}

Json ChartDrawing::barLayer() const {
    Json encoding{{"color", seriesColour()}, {"tooltip", tooltip()}};
    if (y_.isLog()) {
        encoding[valueChannel() + "2"] = {{"datum", y_.begin()}};
    }
    return {{"mark", {{"type", "bar"}, {"orient", lies_ ? "horizontal" : "vertical"}}},
            {"encoding", std::move(encoding)}};
}

Json ChartDrawing::lineLayer() const {
    return {{"mark", {{"type", "line"}, {"strokeWidth", 2}}},
            {"encoding",
             {{"color", seriesColour()},
              {"strokeDash", seriesDash()},
              {"order", {{"field", field::kRow}, {"type", "quantitative"}}}}}};
}

// How the lines are told apart that belong to no series.
Json ChartDrawing::dashOf(const std::string& name) const {
    Json domain = Json::array();
    Json range = Json::array();
    if (!chart_.theory.empty()) {
        domain.push_back(titleOf(chart_.data.columns[chart_.data.columnOf(chart_.theory)]));
        range.push_back({6, 4});
    }
    if (chart_.showFront) {
        domain.push_back(kFrontName);
        range.push_back({2, 3});
    }
    return {{"datum", name},
            {"type", "nominal"},
            {"scale", {{"domain", std::move(domain)}, {"range", std::move(range)}}},
            {"legend",
             {{"title", nullptr},
              {"symbolType", "stroke"},
              {"symbolSize", 700},
              {"symbolStrokeColor", theme_.ink}}}};
}

// One line for all series where they share a theory, else one for each in its colour.
Json ChartDrawing::theoryLayer() const {
    const std::size_t rows = chart_.data.rows.size();
    std::map<Value, std::set<Value>> theoriesAt;
    for (std::size_t row = 0; row < rows; ++row) {
        theoriesAt[valueAt(row, chart_.x.column)].insert(valueAt(row, chart_.theory));
    }
    const bool isEachItsOwn =
        !series_.empty() && std::any_of(theoriesAt.begin(), theoriesAt.end(),
                                        [](const auto& each) { return each.second.size() > 1; });
    std::set<std::vector<Value>> drawn;
    Json points = Json::array();
    for (std::size_t row = 0; row < rows; ++row) {
        const Value series = isEachItsOwn ? valueAt(row, chart_.series) : Value();
        const Value& x = valueAt(row, chart_.x.column);
        const Value& theory = valueAt(row, chart_.theory);
        if (drawn.insert({series, x, theory}).second) {
            points.push_back({{field::kX, x_.position(x)}, {field::kY, y_.position(theory)}});
            if (isEachItsOwn) {
                points.back()[chart_.series] = valueJson(series);
            }
        }
    }
    Json encoding{
        {"strokeDash", dashOf(titleOf(chart_.data.columns[chart_.data.columnOf(chart_.theory)]))}};
    if (isEachItsOwn) {
        encoding["color"] = seriesColour();
    }
    return {{"data", inlineData(std::move(points))},
            {"mark", {{"type", "line"}, {"color", theme_.ink}, {"strokeWidth", 1.5}}},
            {"encoding", std::move(encoding)}};
}

Json ChartDrawing::frontLayer() const {
    Json points = Json::array();
    for (const std::size_t row : frontRows(chart_)) {
        points.push_back({{field::kX, x_.position(valueAt(row, chart_.x.column))},
                          {field::kY, y_.position(valueAt(row, chart_.y.column))}});
    }
    return {{"data", inlineData(std::move(points))},
            {"mark", {{"type", "line"}, {"color", theme_.ink}, {"strokeWidth", 1.5}}},
            {"encoding", {{"strokeDash", dashOf(kFrontName)}}}};
}

Json ChartDrawing::errorLayer() const {
    const bool isOnBars = chart_.mark == ChartMark::kBar;
    return {{"mark", {{"type", "rule"}, {"strokeWidth", 1.5}}},
            {"encoding",
             {{valueChannel(), y_.encoding(field::kLow)},
              {valueChannel() + "2", {{"field", field::kHigh}}},
              {"color", isOnBars ? Json{{"value", theme_.ink}} : seriesColour()}}}};
}

Json ChartDrawing::pointLayer() const {
    const std::size_t lines = std::max<std::size_t>(series_.size(), 1);
    const bool isDense =
        chart_.mark == ChartMark::kLine && chart_.data.rows.size() > lines * kPointsOfAClearLine;
    return {{"mark",
             {{"type", "point"},
              {"filled", true},
              {"opacity", 1},
              {"size", isDense ? kSmallPointSize : kPointSize}}},
            {"encoding",
             {{"color", seriesColour()}, {"shape", seriesShape()}, {"tooltip", tooltip()}}}};
}

Json ChartDrawing::labelLayer() const {
    return {{"transform", filter(std::string("isValid(datum['") + field::kLabelAlign + "'])")},
            {"mark",
             {{"type", "text"},
              {"fontSize", 11},
              {"color", theme_.ink},
              {"align", datumField(field::kLabelAlign)},
              {"dx", datumField(field::kLabelX)},
              {"dy", datumField(field::kLabelY)}}},
            {"encoding", {{"text", {{"field", fieldOf(chart_.label)}, {"type", "nominal"}}}}}};
}

}  // namespace hashphase::demos::detail
