// SPDX-License-Identifier: Zlib
#pragma once

// Where the values of an axis stand, and which of them are written beside it.

#include <demos/report/chart.hpp>
#include <demos/report/json_values.hpp>

#include <optional>
#include <string>
#include <vector>

namespace hashphase::demos {

/// Three to about eight round numbers within [low, high], both above 0, for a logarithmic axis:
/// decades where there are enough, else steps of 1, 2, 5, else even steps.
[[nodiscard]] std::vector<double> logTicks(double low, double high);

class ChartAxis {
public:
    /// For the numbers of the given columns, of which that of the axis is the first.
    ChartAxis(const Chart& chart, const Axis& axis, const std::vector<std::string>& columns);

    /// Where the value stands, in numbers of the drawn scale: 0 of a logarithmic axis has a place
    /// below the smallest number. Null for what cannot be drawn.
    [[nodiscard]] Json position(const Value& value) const;

    /// An encoding of Vega-Lite for an axis that is drawn: field, type, scale and axis.
    [[nodiscard]] Json encoding(const std::string& field) const;

    /// The same for a colour.
    [[nodiscard]] Json colourEncoding(const std::string& field) const;

    [[nodiscard]] bool hasNames() const { return axis_.scale == AxisScale::kNames; }
    [[nodiscard]] bool isLog() const { return isLog_; }
    [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

    /// Of a logarithmic axis: where it begins, and where the gap between 0 and the numbers is.
    [[nodiscard]] double begin() const { return begin_; }
    [[nodiscard]] std::optional<double> gap() const { return gap_; }

    /// The share of the way from the beginning to the end at which the value stands.
    [[nodiscard]] double share(double value) const;

private:
    void findExtent(const DataTable& data, const std::vector<std::string>& columns);
    void findNames(const DataTable& data);
    void layOut();

    Axis axis_;
    ChartMark mark_;
    std::string title_;
    std::vector<std::string> names_;
    bool isLog_ = false;
    bool hasZero_ = false;
    double low_ = 0;  // of the numbers; of a logarithmic axis of those above 0
    double high_ = 0;
    double begin_ = 0;  // of the axis
    double end_ = 1;
    double zeroAt_ = 0;
    std::optional<double> gap_;
};

}  // namespace hashphase::demos
