// SPDX-License-Identifier: Zlib
#include <demos/report/chart_front.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace hashphase::demos {

std::vector<std::size_t> frontRows(const Chart& chart) {
    const std::size_t x = chart.data.columnOf(chart.x.column);
    const std::size_t y = chart.data.columnOf(chart.y.column);
    std::vector<std::tuple<double, double, std::size_t>> points;
    for (std::size_t row = 0; row < chart.data.rows.size(); ++row) {
        const double* atX = std::get_if<double>(&chart.data.rows[row][x]);
        const double* atY = std::get_if<double>(&chart.data.rows[row][y]);
        if (atX != nullptr && atY != nullptr && std::isfinite(*atX) && std::isfinite(*atY)) {
            points.emplace_back(*atX, *atY, row);
        }
    }
    std::sort(points.begin(), points.end());
    std::vector<std::size_t> front;
    double least = 0;
    for (const auto& [atX, atY, row] : points) {
        if (front.empty() || atY < least) {
            front.push_back(row);
            least = atY;
        }
    }
    return front;
}

}  // namespace hashphase::demos
