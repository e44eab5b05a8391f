// SPDX-License-Identifier: Zlib
#pragma once

// A chart, declared: what is drawn against what. demos/report draws it in a page.

#include <demos/report/data_table.hpp>

#include <string>
#include <vector>

namespace hashphase::demos {

enum class AxisScale {
    kLinear,
    kLog,         // every number above 0
    kLogAndZero,  // as kLog, with 0 apart at the lower end
    kNames,       // texts, in the order of the rows
};

struct Axis {
    std::string column;  // of Chart::data; its title names the axis
    AxisScale scale = AxisScale::kLinear;
};

enum class ChartMark {
    kLine,   // a line with points a series, in the order of the rows
    kPoint,  // points
    kBar,    // bars side by side; x are names
    kCell,  // a heat map: x and y are names, the colour is `shade`; numbers among them grow upwards
};

struct Chart {
    std::string name;      // of its files: "P1-missed"; letters, digits and dashes
    std::string title;     // a sentence that says what is to be seen
    std::string settings;  // on what it was measured: scene, numbers, seeds
    ChartMark mark = ChartMark::kLine;
    DataTable data;
    Axis x;
    Axis y;

    /// The column, of texts, that tells the lines, points or bars apart; empty for one series. A
    /// method's colour is the same in all charts of a page; see series_looks.hpp.
    std::string series = {};

    std::string low = {};  // the columns of an error bar around y; empty: none
    std::string high = {};
    std::string label = {};  // a column of texts that name single points, e.g. the time step
    Axis shade = {};         // of kCell

    /// A column with what theory says for this x: drawn as a dashed line without points.
    std::string theory = {};

    /// Draw a line through the points that no other point beats in both x and y (less is better).
    bool showFront = false;
};

}  // namespace hashphase::demos
