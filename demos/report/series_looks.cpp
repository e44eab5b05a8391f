// SPDX-License-Identifier: Zlib
#include <demos/report/series_looks.hpp>

#include <algorithm>
#include <set>

namespace hashphase::demos {
namespace {

/// How often each value is taken, among the series of the same charts and among all.
template <std::size_t Values>
class Uses {
public:
    void count(std::size_t value, bool sharesAChart) {
        ++uses_[value].second;
        uses_[value].first += sharesAChart ? 1 : 0;
    }
    [[nodiscard]] std::size_t leastUsed() const {
        return static_cast<std::size_t>(std::min_element(uses_.begin(), uses_.end()) -
                                        uses_.begin());
    }

private:
    std::array<std::pair<int, int>, Values> uses_{};
};

}  // namespace

std::vector<std::string> seriesOf(const Chart& chart) {
    std::vector<std::string> names;
    if (chart.series.empty()) {
        return names;
    }
    const std::size_t column = chart.data.columnOf(chart.series);
    for (const std::vector<Value>& row : chart.data.rows) {
        std::string name = valueText(row[column]);
        if (std::find(names.begin(), names.end(), name) == names.end()) {
            names.push_back(std::move(name));
        }
    }
    return names;
}

SeriesLooks seriesLooks(std::span<const Chart* const> charts) {
    std::vector<std::vector<std::string>> series;
    std::map<std::string, std::set<std::string>> mates;
    for (const Chart* chart : charts) {
        series.push_back(seriesOf(*chart));
        for (const std::string& name : series.back()) {
            mates[name].insert(series.back().begin(), series.back().end());
        }
    }
    SeriesLooks looks;
    for (const std::vector<std::string>& names : series) {
        for (const std::string& name : names) {
            if (looks.contains(name)) {
                continue;
            }
            Uses<kSeriesColours> colours;
            Uses<kSeriesShapes.size()> shapes;
            for (const auto& [other, look] : looks) {
                colours.count(look.colour, mates[name].contains(other));
                shapes.count(look.shape, mates[name].contains(other));
            }
            looks[name] = {colours.leastUsed(), shapes.leastUsed()};
        }
    }
    return looks;
}

}  // namespace hashphase::demos
