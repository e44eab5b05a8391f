// SPDX-License-Identifier: Zlib
#include <demos/report/chart_drawing.hpp>

#include <demos/report/chart_labels.hpp>

#include <algorithm>
#include <array>
#include <utility>

namespace hashphase::demos::detail {
namespace {

constexpr double kBrightFrom = 0.55;  // of the way along the colours of a heat map
constexpr int kBarHeight = 18;
constexpr int kLongestName = 45;  // [letters] beside an axis; the rest is cut off

bool areNumbers(const std::vector<std::string>& names) {
    return std::all_of(names.begin(), names.end(), [](const std::string& name) {
        return name.find_first_not_of("0123456789.,e+-") == std::string::npos;
    });
}

std::size_t longest(const std::vector<std::string>& names) {
    std::size_t letters = 0;
    for (const std::string& name : names) {
        letters = std::max(letters, name.size());
    }
    return letters;
}

}  // namespace

std::string fieldOf(const std::string& column) {
    std::string field;
    for (const char letter : column) {
        if (std::string_view(".[]\\'\"").find(letter) != std::string_view::npos) {
            field += '\\';
        }
        field += letter;
    }
    return field;
}

ChartDrawing::ChartDrawing(const Chart& chart, const SeriesLooks& looks, const ChartTheme& theme)
    : chart_(chart),
      looks_(looks),
      theme_(theme),
      series_(seriesOf(chart)),
      x_(chart, chart.x, {chart.x.column}),
      y_(chart, chart.y, {chart.y.column, chart.low, chart.high, chart.theory}) {
    if (chart.mark == ChartMark::kCell) {
        shade_.emplace(chart, chart.shade, std::vector{chart.shade.column});
    }
    // Bars lie where their names would not stand side by side.
    lies_ = chart.mark == ChartMark::kBar &&
            (longest(x_.names()) + 2) * x_.names().size() * kLetterWidth > kWidth;
}

const std::vector<std::string>* ChartDrawing::namesAtTheLeft() const {
    const ChartAxis& left = lies_ ? x_ : y_;
    return left.hasNames() ? &left.names() : nullptr;
}

Json ChartDrawing::width() const {
    const std::vector<std::string>* names = namesAtTheLeft();
    const int letters =
        names != nullptr ? std::min(static_cast<int>(longest(*names)), kLongestName) : 0;
    return kWidth - letters * kLetterWidth;
}

Json ChartDrawing::height() const {
    if (namesAtTheLeft() == nullptr) {
        return kHeight;
    }
    return {{"step", lies_ && !isOneSeries() ? kBarHeight : kBarHeight * 3 / 2}};
}

SeriesLook ChartDrawing::lookOf(const std::string& name) const {
    const auto found = looks_.find(name);
    return found == looks_.end() ? SeriesLook{} : found->second;
}

Json ChartDrawing::values() const {
    Json rows = Json::array();
    const DataTable& data = chart_.data;
    for (std::size_t row = 0; row < data.rows.size(); ++row) {
        Json datum = Json::object();
        for (std::size_t i = 0; i < data.columns.size(); ++i) {
            datum[data.columns[i].name] = valueJson(data.rows[row][i]);
        }
        datum[field::kRow] = row;
        datum[field::kX] = x_.position(valueAt(row, chart_.x.column));
        datum[field::kY] = y_.position(valueAt(row, chart_.y.column));
        if (!chart_.low.empty()) {
            datum[field::kLow] = y_.position(valueAt(row, chart_.low));
            datum[field::kHigh] = y_.position(valueAt(row, chart_.high));
        }
        if (shade_) {
            const Value& shade = valueAt(row, chart_.shade.column);
            const Json at = shade_->position(shade);
            datum[field::kShade] = at;
            datum[field::kShadeText] = valueText(shade);
            datum[field::kIsBright] = !at.is_null() && shade_->share(at) > kBrightFrom;
        }
        rows.push_back(std::move(datum));
    }
    if (!chart_.label.empty()) {
        addLabelPlaces(rows);
    }
    return rows;
}

void ChartDrawing::addLabelPlaces(Json& rows) const {
    std::vector<LabelledPoint> points;
    std::vector<std::size_t> rowOf;
    for (std::size_t row = 0; row < rows.size(); ++row) {
        const Json& x = rows[row][field::kX];
        const Json& y = rows[row][field::kY];
        if (x.is_number() && y.is_number()) {
            const Value& label = valueAt(row, chart_.label);
            points.push_back({x_.share(x) * kWidth, (1 - y_.share(y)) * kHeight,
                              label.index() == 0 ? std::string() : valueText(label)});
            rowOf.push_back(row);
        }
    }
    const std::vector<LabelPlace> places = placeLabels(points, kWidth);
    for (std::size_t i = 0; i < places.size(); ++i) {
        rows[rowOf[i]][field::kLabelAlign] = places[i].align;
        rows[rowOf[i]][field::kLabelX] = places[i].dx;
        rows[rowOf[i]][field::kLabelY] = places[i].dy;
    }
}

Json ChartDrawing::encoding() const {
    Json x = x_.encoding(field::kX);
    Json y = y_.encoding(field::kY);
    if (y_.hasNames() && areNumbers(y_.names())) {
        y["sort"] = std::vector<std::string>(y_.names().rbegin(), y_.names().rend());
    }
    if (x_.hasNames()) {
        x["axis"]["labelAngle"] = 0;
    }
    if (lies_) {
        std::swap(x, y);
        y["axis"]["title"] = nullptr;  // the names speak for themselves
    }
    if (namesAtTheLeft() != nullptr) {
        const std::string limit = std::to_string(kLongestName);
        y["axis"]["labelExpr"] = "length(datum.label) > " + limit + " ? slice(datum.label, 0, " +
                                 limit + " - 1) + '\u2026' : datum.label";
    }
    Json encoding{{"x", std::move(x)}, {"y", std::move(y)}};
    if (chart_.mark == ChartMark::kBar && !isOneSeries()) {
        encoding[nameChannel() + "Offset"] = {
            {"field", fieldOf(chart_.series)}, {"type", "nominal"}, {"sort", series_}};
    }
    return encoding;
}

Json ChartDrawing::tooltip() const {
    Json fields = Json::array();
    for (std::size_t i = 0; i < chart_.data.columns.size(); ++i) {
        const DataColumn& column = chart_.data.columns[i];
        const auto holdsText = [i](const std::vector<Value>& row) {
            return std::holds_alternative<std::string>(row[i]);
        };
        Json field{{"field", fieldOf(column.name)}, {"title", titleOf(column)}};
        if (std::any_of(chart_.data.rows.begin(), chart_.data.rows.end(), holdsText)) {
            field["type"] = "nominal";
        } else {
            field["type"] = "quantitative";
            field["format"] = ",.4~g";
        }
        fields.push_back(std::move(field));
    }
    return fields;
}

// As many names side by side as fit.
Json ChartDrawing::legend() const {
    if (isOneSeries()) {
        return nullptr;
    }
    const int columns = kWidth / (static_cast<int>(longest(series_)) * kLetterWidth + 30);
    return {{"title", nullptr}, {"columns", std::max(columns, 1)}};
}

Json ChartDrawing::seriesScale(const std::vector<std::string>& range) const {
    return {{"field", fieldOf(chart_.series)},
            {"type", "nominal"},
            {"scale", {{"domain", series_}, {"range", range}}},
            {"legend", legend()}};
}

Json ChartDrawing::seriesColour() const {
    if (series_.empty()) {
        return {{"value", theme_.series[0]}};
    }
    std::vector<std::string> colours;
    for (const std::string& name : series_) {
        colours.push_back(theme_.series[lookOf(name).colour]);
    }
    return seriesScale(colours);
}

// Without a scale, which would be that of dashOf(), and without a legend: that has the shapes.
Json ChartDrawing::seriesDash() const {
    static const std::array<std::vector<int>, 6> kDashes{
        {{1, 0}, {8, 4}, {2, 3}, {10, 3, 2, 3}, {4, 4}, {14, 4}}};
    Json conditions = Json::array();
    for (const std::string& name : series_) {
        conditions.push_back(
            {{"test", "datum[" + Json(chart_.series).dump() + "] === " + Json(name).dump()},
             {"value", kDashes[lookOf(name).dash % kDashes.size()]}});
    }
    Json dash{{"value", kDashes[0]}};
    if (!conditions.empty()) {
        dash["condition"] = std::move(conditions);
    }
    return dash;
}

Json ChartDrawing::seriesShape() const {
    if (series_.empty()) {
        return {{"value", kSeriesShapes[0]}};
    }
    std::vector<std::string> shapes;
    for (const std::string& name : series_) {
        shapes.emplace_back(kSeriesShapes[lookOf(name).shape]);
    }
    return seriesScale(shapes);
}

}  // namespace hashphase::demos::detail
