// SPDX-License-Identifier: Zlib
#pragma once

// How vega_lite.cpp makes the parts of a chart.

#include <demos/report/chart_axis.hpp>
#include <demos/report/vega_lite.hpp>

#include <optional>
#include <string>
#include <vector>

namespace hashphase::demos::detail {

inline constexpr int kWidth = 660;  // [px], of a chart with what stands to its left
inline constexpr int kHeight = 360;
inline constexpr int kLetterWidth = 7;

/// Fields of the drawn data. They have blanks, which names of columns have not.
namespace field {
inline constexpr const char* kX = "at x";
inline constexpr const char* kY = "at y";
inline constexpr const char* kLow = "at low";
inline constexpr const char* kHigh = "at high";
inline constexpr const char* kShade = "at shade";
inline constexpr const char* kShadeText = "text of shade";
inline constexpr const char* kIsBright = "is bright";
inline constexpr const char* kRow = "row number";
inline constexpr const char* kLabelAlign = "label align";
inline constexpr const char* kLabelX = "label dx";
inline constexpr const char* kLabelY = "label dy";
}  // namespace field

/// A column's name as a field of Vega, which reads some letters as a path unless they are escaped.
[[nodiscard]] std::string fieldOf(const std::string& column);

/// A chart that is being drawn: its data, its axes, and layer by layer what is seen.
class ChartDrawing {
public:
    ChartDrawing(const Chart& chart, const SeriesLooks& looks, const ChartTheme& theme);

    [[nodiscard]] Json values() const;

    /// What all layers have in common.
    [[nodiscard]] Json encoding() const;
    [[nodiscard]] Json layers() const;
    [[nodiscard]] Json width() const;
    [[nodiscard]] Json height() const;

private:
    [[nodiscard]] Json tooltip() const;
    [[nodiscard]] Json legend() const;
    [[nodiscard]] Json seriesColour() const;
    [[nodiscard]] Json seriesShape() const;
    [[nodiscard]] Json seriesDash() const;
    [[nodiscard]] Json seriesScale(const std::vector<std::string>& range) const;
    void addLabelPlaces(Json& rows) const;

    void addGapLayers(Json& layers) const;
    void addCellLayers(Json& layers) const;
    [[nodiscard]] Json barLayer() const;
    [[nodiscard]] Json lineLayer() const;
    [[nodiscard]] Json theoryLayer() const;
    [[nodiscard]] Json frontLayer() const;
    [[nodiscard]] Json dashOf(const std::string& name) const;
    [[nodiscard]] Json errorLayer() const;
    [[nodiscard]] Json pointLayer() const;
    [[nodiscard]] Json labelLayer() const;

    // The channels along which bars grow, and beside which they stand.
    [[nodiscard]] std::string valueChannel() const { return lies_ ? "x" : "y"; }
    [[nodiscard]] std::string nameChannel() const { return lies_ ? "y" : "x"; }

    [[nodiscard]] bool isOneSeries() const {
        return series_.empty() || chart_.series == chart_.x.column;
    }
    [[nodiscard]] SeriesLook lookOf(const std::string& name) const;
    [[nodiscard]] const Value& valueAt(std::size_t row, const std::string& column) const {
        return chart_.data.rows[row][chart_.data.columnOf(column)];
    }
    [[nodiscard]] const std::vector<std::string>* namesAtTheLeft() const;

    const Chart& chart_;
    const SeriesLooks& looks_;
    const ChartTheme& theme_;
    std::vector<std::string> series_;
    ChartAxis x_;
    ChartAxis y_;
    std::optional<ChartAxis> shade_;
    bool lies_ = false;  // of bars
};

}  // namespace hashphase::demos::detail
