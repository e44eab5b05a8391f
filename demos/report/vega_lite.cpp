// SPDX-License-Identifier: Zlib
#include <demos/report/vega_lite.hpp>

#include <demos/report/chart_axis.hpp>
#include <demos/report/chart_front.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace hashphase::demos {
namespace {

constexpr int kWidth = 660;
constexpr int kHeight = 360;
constexpr std::size_t kLettersOfATitle = 84;  // that fit into the width, in bold
constexpr std::size_t kLettersOfASubtitle = 105;
constexpr int kPixelsOfALetter = 7;
constexpr std::size_t kPointsOfAClearLine = 40;  // more of them hide the line

// Fields of the drawn data. They have blanks, which names of columns have not.
constexpr const char* kAtX = "at x";
constexpr const char* kAtY = "at y";
constexpr const char* kAtLow = "at low";
constexpr const char* kAtHigh = "at high";
constexpr const char* kAtShade = "at shade";
constexpr const char* kShadeText = "text of shade";
constexpr const char* kShadeInk = "ink on shade";
constexpr const char* kRow = "row number";

// Vega reads these as a path into the datum unless they are escaped.
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

bool areNumbers(const std::vector<std::string>& names) {
    return std::all_of(names.begin(), names.end(), [](const std::string& name) {
        return name.find_first_not_of("0123456789.,e+-") == std::string::npos;
    });
}

/// Builds the spec of one chart.
class Drawing {
public:
    Drawing(const Chart& chart, const SeriesLooks& looks, const ChartTheme& theme)
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
        std::size_t letters = 0;
        for (const std::string& name : x_.names()) {
            letters += name.size() + 2;
        }
        lies_ = chart.mark == ChartMark::kBar && letters * kPixelsOfALetter > kWidth;
    }

    [[nodiscard]] Json spec(ChartTitle title) const;

private:
    [[nodiscard]] Json values() const;
    [[nodiscard]] Json encoding() const;
    [[nodiscard]] Json tooltip() const;
    [[nodiscard]] Json seriesColour() const;
    [[nodiscard]] Json seriesShape() const;
    [[nodiscard]] Json legend() const;
    [[nodiscard]] Json config() const;
    [[nodiscard]] Json gapLayers() const;
    [[nodiscard]] Json theoryLayer() const;
    [[nodiscard]] Json frontLayer() const;
    [[nodiscard]] Json dashOf(const std::string& name) const;
    [[nodiscard]] Json errorLayer() const;
    [[nodiscard]] Json barLayer() const;
    [[nodiscard]] Json lineLayer() const;
    [[nodiscard]] Json pointLayer() const;
    [[nodiscard]] Json labelLayer() const;
    void addCellLayers(Json& layers) const;

    // The channels along which the bars stand or lie.
    [[nodiscard]] const char* mainChannel() const { return lies_ ? "y" : "x"; }
    [[nodiscard]] const char* valueChannel() const { return lies_ ? "x" : "y"; }
    [[nodiscard]] std::string farChannel() const { return std::string(valueChannel()) + "2"; }

    [[nodiscard]] bool isOneSeries() const {
        return series_.empty() || chart_.series == chart_.x.column;
    }
    [[nodiscard]] SeriesLook lookOf(const std::string& name) const {
        const auto found = looks_.find(name);
        return found == looks_.end() ? SeriesLook{} : found->second;
    }
    [[nodiscard]] std::string theoryTitle() const {
        return titleOf(chart_.data.columns[chart_.data.columnOf(chart_.theory)]);
    }

    const Chart& chart_;
    const SeriesLooks& looks_;
    const ChartTheme& theme_;
    std::vector<std::string> series_;
    ChartAxis x_;
    ChartAxis y_;
    std::optional<ChartAxis> shade_;
    bool lies_ = false;
};

Json Drawing::values() const {
    Json rows = Json::array();
    const DataTable& data = chart_.data;
    const auto at = [&data](const std::vector<Value>& row, const std::string& column) {
        return row[data.columnOf(column)];
    };
    for (const std::vector<Value>& row : data.rows) {
        Json datum = Json::object();
        for (std::size_t i = 0; i < data.columns.size(); ++i) {
            datum[data.columns[i].name] = valueJson(row[i]);
        }
        datum[kAtX] = x_.position(at(row, chart_.x.column));
        datum[kAtY] = y_.position(at(row, chart_.y.column));
        if (!chart_.low.empty()) {
            datum[kAtLow] = y_.position(at(row, chart_.low));
            datum[kAtHigh] = y_.position(at(row, chart_.high));
        }
        if (shade_) {
            const Value shade = at(row, chart_.shade.column);
            const Json position = shade_->position(shade);
            datum[kAtShade] = position;
            datum[kShadeText] = valueText(shade);
            const bool isBright = !position.is_null() && shade_->share(position) > 0.55;
            datum[kShadeInk] = isBright ? "#000000" : "#ffffff";
        }
        datum[kRow] = rows.size();
        rows.push_back(std::move(datum));
    }
    return rows;
}

Json Drawing::encoding() const {
    Json x = x_.encoding(kAtX);
    Json y = y_.encoding(kAtY);
    if (y_.hasNames() && areNumbers(y_.names())) {
        y["sort"] = std::vector<std::string>(y_.names().rbegin(), y_.names().rend());
    }
    if (lies_) {
        std::swap(x, y);
    }
    if (chart_.mark != ChartMark::kBar && x_.hasNames()) {
        x["axis"]["labelAngle"] = 0;
    }
    Json encoding{{"x", std::move(x)}, {"y", std::move(y)}};
    if (chart_.mark == ChartMark::kBar) {
        encoding[mainChannel()]["axis"]["labelAngle"] = 0;
        if (!isOneSeries()) {
            encoding[std::string(mainChannel()) + "Offset"] = {
                {"field", fieldOf(chart_.series)}, {"type", "nominal"}, {"sort", series_}};
        }
    }
    return encoding;
}

Json Drawing::tooltip() const {
    Json fields = Json::array();
    for (const DataColumn& column : chart_.data.columns) {
        const auto holdsText = [i = chart_.data.columnOf(column.name)](const auto& row) {
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
Json Drawing::legend() const {
    if (isOneSeries()) {
        return nullptr;
    }
    std::size_t longest = 0;
    for (const std::string& name : series_) {
        longest = std::max(longest, name.size());
    }
    const int columns = kWidth / (static_cast<int>(longest) * kPixelsOfALetter + 30);
    return {{"title", nullptr}, {"columns", std::max(columns, 1)}};
}

Json Drawing::seriesColour() const {
    if (series_.empty()) {
        return {{"value", theme_.series[0]}};
    }
    Json range = Json::array();
    for (const std::string& name : series_) {
        range.push_back(theme_.series[lookOf(name).colour]);
    }
    return {{"field", fieldOf(chart_.series)},
            {"type", "nominal"},
            {"scale", {{"domain", series_}, {"range", std::move(range)}}},
            {"legend", legend()}};
}

Json Drawing::seriesShape() const {
    if (series_.empty()) {
        return {{"value", kSeriesShapes[0]}};
    }
    Json range = Json::array();
    for (const std::string& name : series_) {
        range.push_back(kSeriesShapes[lookOf(name).shape]);
    }
    return {{"field", fieldOf(chart_.series)},
            {"type", "nominal"},
            {"scale", {{"domain", series_}, {"range", std::move(range)}}},
            {"legend", legend()}};
}

// A dotted line between the numbers and 0, which a logarithmic axis does not reach.
Json Drawing::gapLayers() const {
    Json layers = Json::array();
    for (const auto& [axis, channel] :
         {std::pair(&x_, lies_ ? "y" : "x"), std::pair(&y_, lies_ ? "x" : "y")}) {
        if (axis->gap()) {
            layers.push_back({{"data", {{"values", Json::array({Json::object()})}}},
                              {"mark",
                               {{"type", "rule"},
                                {"color", theme_.ink},
                                {"strokeDash", {1, 4}},
                                {"opacity", 0.6}}},
                              {"encoding",
                               {{channel, {{"datum", *axis->gap()}, {"type", "quantitative"}}},
                                {channel == std::string("x") ? "y" : "x", nullptr}}}});
        }
    }
    return layers;
}

// How the lines are told apart that belong to no series.
Json Drawing::dashOf(const std::string& name) const {
    Json domain = Json::array();
    Json range = Json::array();
    if (!chart_.theory.empty()) {
        domain.push_back(theoryTitle());
        range.push_back({7, 4});
    }
    if (chart_.showFront) {
        domain.push_back(kFrontName);
        range.push_back({2, 3});
    }
    return {{"datum", name},
            {"type", "nominal"},
            {"scale", {{"domain", std::move(domain)}, {"range", std::move(range)}}},
            {"legend", {{"title", nullptr}, {"symbolStrokeColor", theme_.ink}}}};
}

// One line for all series where they share a theory, else one for each in its colour.
Json Drawing::theoryLayer() const {
    const std::size_t x = chart_.data.columnOf(chart_.x.column);
    const std::size_t theory = chart_.data.columnOf(chart_.theory);
    std::map<Value, std::set<Value>> theoriesAt;
    for (const std::vector<Value>& row : chart_.data.rows) {
        theoriesAt[row[x]].insert(row[theory]);
    }
    const bool isShared = std::all_of(theoriesAt.begin(), theoriesAt.end(),
                                      [](const auto& each) { return each.second.size() == 1; });
    std::set<std::vector<Value>> drawn;
    Json points = Json::array();
    for (const std::vector<Value>& row : chart_.data.rows) {
        const Value series =
            isShared || series_.empty() ? Value{} : row[chart_.data.columnOf(chart_.series)];
        const Json at = y_.position(row[theory]);
        if (!at.is_null() && drawn.insert({series, row[x], row[theory]}).second) {
            points.push_back(
                {{kAtX, x_.position(row[x])}, {kAtY, at}, {chart_.series, valueJson(series)}});
        }
    }
    Json encoding{{"strokeDash", dashOf(theoryTitle())}};
    if (!isShared && !series_.empty()) {
        encoding["color"] = seriesColour();
    }
    return {{"data", {{"values", std::move(points)}}},
            {"mark", {{"type", "line"}, {"color", theme_.ink}, {"strokeWidth", 1.5}}},
            {"encoding", std::move(encoding)}};
}

Json Drawing::frontLayer() const {
    Json points = Json::array();
    for (const std::size_t row : frontRows(chart_)) {
        const std::vector<Value>& values = chart_.data.rows[row];
        points.push_back({{kAtX, x_.position(values[chart_.data.columnOf(chart_.x.column)])},
                          {kAtY, y_.position(values[chart_.data.columnOf(chart_.y.column)])}});
    }
    return {{"data", {{"values", std::move(points)}}},
            {"mark", {{"type", "line"}, {"color", theme_.ink}, {"strokeWidth", 1.5}}},
            {"encoding", {{"strokeDash", dashOf(kFrontName)}}}};
}

Json Drawing::errorLayer() const {
    Json low = y_.encoding(kAtLow);
    return {{"mark", {{"type", "rule"}, {"strokeWidth", 1.5}, {"opacity", 0.8}}},
            {"encoding",
             {{valueChannel(), std::move(low)},
              {farChannel(), {{"field", kAtHigh}}},
              {"color",
               chart_.mark == ChartMark::kBar ? Json{{"value", theme_.ink}} : seriesColour()}}}};
}

Json Drawing::barLayer() const {
    Json encoding{{"color", seriesColour()}, {"tooltip", tooltip()}};
    if (y_.isLog()) {
        encoding[farChannel()] = {{"datum", y_.begin()}};
    }
    return {{"mark", {{"type", "bar"}}}, {"encoding", std::move(encoding)}};
}

Json Drawing::lineLayer() const {
    return {{"mark", {{"type", "line"}, {"strokeWidth", 2}}},
            {"encoding",
             {{"color", seriesColour()}, {"order", {{"field", kRow}, {"type", "quantitative"}}}}}};
}

Json Drawing::pointLayer() const {
    const std::size_t lines = std::max<std::size_t>(series_.size(), 1);
    const bool isDense =
        chart_.mark == ChartMark::kLine && chart_.data.rows.size() / lines > kPointsOfAClearLine;
    return {{"mark",
             {{"type", "point"}, {"filled", true}, {"opacity", 1}, {"size", isDense ? 12 : 60}}},
            {"encoding",
             {{"color", seriesColour()}, {"shape", seriesShape()}, {"tooltip", tooltip()}}}};
}

Json Drawing::labelLayer() const {
    return {{"mark",
             {{"type", "text"},
              {"align", "left"},
              {"dx", 7},
              {"dy", -7},
              {"fontSize", 11},
              {"color", theme_.ink}}},
            {"encoding", {{"text", {{"field", fieldOf(chart_.label)}, {"type", "nominal"}}}}}};
}

void Drawing::addCellLayers(Json& layers) const {
    layers.push_back(
        {{"mark", {{"type", "rect"}}},
         {"encoding", {{"color", shade_->colourEncoding(kAtShade)}, {"tooltip", tooltip()}}}});
    layers.push_back(
        {{"transform",
          Json::array({{{"filter", std::string("isValid(datum['") + kAtShade + "'])"}}})},
         {"mark", {{"type", "text"}, {"fontSize", 11}}},
         {"encoding",
          {{"text", {{"field", kShadeText}, {"type", "nominal"}}},
           {"color", {{"field", kShadeInk}, {"type", "nominal"}, {"scale", nullptr}}}}}});
}

Json Drawing::config() const {
    const Json text{{"labelColor", theme_.ink},    {"titleColor", theme_.ink},
                    {"labelFontSize", 12},         {"titleFontSize", 13},
                    {"titleFontWeight", "normal"}, {"labelLimit", 400}};
    Json axis = text;
    axis.update({{"gridColor", theme_.faint},
                 {"domainColor", theme_.ink},
                 {"tickColor", theme_.ink},
                 {"titlePadding", 8},
                 {"labelOverlap", true}});
    Json legend = text;
    legend.update({{"orient", "bottom"},
                   {"direction", "horizontal"},
                   {"symbolSize", 90},
                   {"columnPadding", 18},
                   {"offset", 14}});
    return {{"font", "system-ui, sans-serif"},
            {"background", theme_.background.empty() ? Json(nullptr) : Json(theme_.background)},
            {"axis", std::move(axis)},
            {"legend", std::move(legend)},
            {"view", {{"stroke", nullptr}}},
            {"title",
             {{"anchor", "start"},
              {"color", theme_.ink},
              {"subtitleColor", theme_.ink},
              {"fontSize", 15},
              {"subtitleFontSize", 12},
              {"subtitlePadding", 6},
              {"offset", 16}}}};
}

Json Drawing::spec(ChartTitle title) const {
    Json layers = chart_.mark == ChartMark::kCell ? Json::array() : gapLayers();
    if (!chart_.theory.empty()) {
        layers.push_back(theoryLayer());
    }
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
            [[fallthrough]];
        case ChartMark::kPoint:
            layers.push_back(pointLayer());
            break;
    }
    if (!chart_.low.empty()) {
        layers.push_back(errorLayer());
    }
    if (!chart_.label.empty()) {
        layers.push_back(labelLayer());
    }
    Json spec{{"$schema", "https://vega.github.io/schema/vega-lite/v6.json"},
              {"description", chart_.title}};
    if (title == ChartTitle::kInside) {
        spec["title"] = {{"text", lines(chart_.title, kLettersOfATitle)},
                         {"subtitle", lines(chart_.settings, kLettersOfASubtitle)}};
    }
    spec["width"] = kWidth;
    spec["height"] =
        lies_ || y_.hasNames() ? Json{{"step", isOneSeries() ? 30 : 18}} : Json(kHeight);
    spec["data"] = {{"values", values()}};
    spec["encoding"] = encoding();
    spec["layer"] = std::move(layers);
    spec["config"] = config();
    return spec;
}

}  // namespace

Json vegaLiteSpec(const Chart& chart, const SeriesLooks& looks, const ChartTheme& theme,
                  ChartTitle title) {
    return Drawing(chart, looks, theme).spec(title);
}

}  // namespace hashphase::demos
