// SPDX-License-Identifier: Zlib
#include <demos/report/chart_axis.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hashphase::demos {
namespace {

constexpr std::size_t kMostTicks = 8;
constexpr std::size_t kFewestTicks = 3;

// Room at the ends of a logarithmic axis, and between its numbers and 0, as a share of its length.
constexpr double kMargin = 0.03;
constexpr double kGap = 0.12;

// How many times longer than where it begins a bar on a logarithmic axis is at least.
constexpr double kLeastBar = 1.5;

std::vector<double> decades(double low, double high, const std::vector<double>& steps, int stride) {
    std::vector<double> ticks;
    const int last = static_cast<int>(std::floor(std::log10(high)));
    for (int decade = static_cast<int>(std::floor(std::log10(low))); decade <= last; ++decade) {
        for (const double step : steps) {
            const double tick = step * std::pow(10.0, decade);
            if (tick >= low && tick <= high && decade % stride == 0) {
                ticks.push_back(tick);
            }
        }
    }
    return ticks;
}

std::vector<double> evenSteps(double low, double high) {
    const double rough = (high - low) / 5;
    const double decade = std::pow(10.0, std::floor(std::log10(rough)));
    const double step = decade * (rough / decade > 5 ? 10 : rough / decade > 2 ? 5 : 2);
    std::vector<double> ticks;
    for (double i = std::ceil(low / step); i * step <= high; ++i) {
        ticks.push_back(i * step);
    }
    return ticks;
}

// "0.001", "50", "20k", "1e-7": as short as they are read.
std::string labelExpression(std::optional<double> zeroAt) {
    const std::string number =
        "datum.value >= 10000 ? format(datum.value, '~s') : datum.value < 0.0001 ? "
        "format(datum.value, '~e') : format(datum.value, '~g')";
    return zeroAt ? "datum.value <= " + Json(*zeroAt).dump() + " ? '0' : " + number : number;
}

}  // namespace

std::vector<double> logTicks(double low, double high) {
    for (int stride = 1; std::log10(high / low) >= 2; ++stride) {
        std::vector<double> ticks = decades(low, high, {1}, stride);
        if (ticks.size() <= kMostTicks) {
            return ticks;
        }
    }
    if (low >= high) {
        return {low};
    }
    std::vector<double> ticks = decades(low, high, {1, 2, 5}, 1);
    return ticks.size() >= kFewestTicks ? ticks : evenSteps(low, high);
}

ChartAxis::ChartAxis(const Chart& chart, const Axis& axis, const std::vector<std::string>& columns)
    : axis_(axis),
      mark_(chart.mark),
      title_(titleOf(chart.data.columns[chart.data.columnOf(axis.column)])) {
    if (hasNames()) {
        findNames(chart.data);
        return;
    }
    findExtent(chart.data, columns);
    layOut();
}

void ChartAxis::findNames(const DataTable& data) {
    const std::size_t column = data.columnOf(axis_.column);
    for (const std::vector<Value>& row : data.rows) {
        std::string name = valueText(row[column]);
        if (std::find(names_.begin(), names_.end(), name) == names_.end()) {
            names_.push_back(std::move(name));
        }
    }
}

void ChartAxis::findExtent(const DataTable& data, const std::vector<std::string>& columns) {
    const bool wantsLog = axis_.scale != AxisScale::kLinear;
    low_ = std::numeric_limits<double>::infinity();
    high_ = -low_;
    for (const std::string& name : columns) {
        if (name.empty()) {
            continue;
        }
        const std::size_t column = data.columnOf(name);
        for (const std::vector<Value>& row : data.rows) {
            const double* number = std::get_if<double>(&row[column]);
            if (number == nullptr || !std::isfinite(*number)) {
                continue;
            }
            if (wantsLog && *number <= 0) {
                hasZero_ = hasZero_ || axis_.scale == AxisScale::kLogAndZero;
                continue;
            }
            low_ = std::min(low_, *number);
            high_ = std::max(high_, *number);
        }
    }
    // Where all is zero, there is nothing that a logarithm could tell apart.
    isLog_ = wantsLog && low_ <= high_;
}

void ChartAxis::layOut() {
    if (!isLog_) {
        begin_ = std::min(low_, 0.0);
        end_ = high_ > begin_ ? high_ : begin_ + 1;
        return;
    }
    const double decades = std::max(std::log10(high_ / low_), 0.3);
    begin_ = low_ * std::pow(10.0, -kMargin * decades);
    end_ = high_ * std::pow(10.0, kMargin * decades);
    if (mark_ == ChartMark::kBar) {
        // A bar must have some length, and begins at a round number.
        begin_ = std::pow(10.0, std::floor(std::log10(low_ / kLeastBar)));
        low_ = begin_;
    }
    if (hasZero_) {
        gap_ = low_ * std::pow(10.0, -kGap / 2 * decades);
        zeroAt_ = low_ * std::pow(10.0, -kGap * decades);
        begin_ = zeroAt_ * std::pow(10.0, -kMargin * decades);
    }
}

Json ChartAxis::position(const Value& value) const {
    if (hasNames()) {
        return valueText(value);
    }
    const double* number = std::get_if<double>(&value);
    if (number == nullptr || !std::isfinite(*number)) {
        return nullptr;
    }
    if (isLog_ && *number <= 0) {
        return hasZero_ ? Json(zeroAt_) : Json(nullptr);
    }
    return *number;
}

double ChartAxis::share(double value) const {
    return isLog_ ? std::log(value / begin_) / std::log(end_ / begin_)
                  : (value - begin_) / (end_ - begin_);
}

Json ChartAxis::encoding(const std::string& field) const {
    Json axis{{"title", title_}};
    if (hasNames()) {
        axis["grid"] = false;
        const bool areWide = mark_ == ChartMark::kBar || mark_ == ChartMark::kCell;
        return {{"field", field},
                {"type", "nominal"},
                {"sort", names_},
                {"scale", {{"type", areWide ? "band" : "point"}}},
                {"axis", axis}};
    }
    Json scale{{"type", "linear"}};
    if (isLog_) {
        std::vector<double> ticks = logTicks(low_, high_);
        if (hasZero_) {
            ticks.insert(ticks.begin(), zeroAt_);
        }
        axis["values"] = ticks;
        axis["labelExpr"] = labelExpression(hasZero_ ? std::optional(zeroAt_) : std::nullopt);
        scale = {{"type", "log"}, {"domain", {begin_, end_}}, {"nice", false}};
    }
    return {{"field", field}, {"type", "quantitative"}, {"scale", scale}, {"axis", axis}};
}

Json ChartAxis::colourEncoding(const std::string& field) const {
    Json encoding = this->encoding(field);
    encoding["scale"]["scheme"] = "viridis";
    encoding["legend"] = std::move(encoding["axis"]);
    encoding.erase("axis");
    return encoding;
}

}  // namespace hashphase::demos
