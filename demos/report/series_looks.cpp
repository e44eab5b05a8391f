// SPDX-License-Identifier: Zlib
#include <demos/report/series_looks.hpp>

#include <algorithm>
#include <set>

namespace hashphase::demos {
namespace {

/// How often each value is taken: what counts most comes first.
template <std::size_t Values, std::size_t Ranks>
class Uses {
public:
    /// By something of that rank, the first being 0.
    void count(std::size_t value, std::size_t rank) {
        for (std::size_t i = rank; i < Ranks; ++i) {
            ++uses_[value][i];
        }
    }
    [[nodiscard]] std::size_t leastUsed() const {
        return static_cast<std::size_t>(std::min_element(uses_.begin(), uses_.end()) -
                                        uses_.begin());
    }

private:
    std::array<std::array<int, Ranks>, Values> uses_{};
};

/// Who shares a chart with whom.
using Mates = std::map<std::string, std::set<std::string>, std::less<>>;

using Colours = std::map<std::string, std::size_t, std::less<>>;

std::size_t colourFor(const Colours& colours, const std::set<std::string>& mates) {
    Uses<kSeriesColours, 2> uses;
    for (const auto& [other, colour] : colours) {
        uses.count(colour, mates.contains(other) ? 0 : 1);
    }
    return uses.leastUsed();
}

std::size_t shapeFor(const SeriesLooks& looks, std::size_t colour,
                     const std::set<std::string>& mates) {
    Uses<kSeriesShapes.size(), 3> uses;
    for (const auto& [other, look] : looks) {
        uses.count(look.shape, !mates.contains(other) ? 2 : look.colour == colour ? 0 : 1);
    }
    return uses.leastUsed();
}

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

std::string_view methodOf(std::string_view series) {
    return series.substr(0, series.find(", "));
}

SeriesLooks seriesLooks(std::span<const Chart* const> charts) {
    std::vector<std::vector<std::string>> series;
    Mates mates;
    Mates mateMethods;
    for (const Chart* chart : charts) {
        series.push_back(seriesOf(*chart));
        for (const std::string& name : series.back()) {
            mates[name].insert(series.back().begin(), series.back().end());
            for (const std::string& other : series.back()) {
                mateMethods[std::string(methodOf(name))].emplace(methodOf(other));
            }
        }
    }
    SeriesLooks looks;
    Colours colours;
    std::map<std::string, std::size_t, std::less<>> variants;
    for (const std::vector<std::string>& names : series) {
        for (const std::string& name : names) {
            if (looks.contains(name)) {
                continue;
            }
            const std::string method(methodOf(name));
            if (!colours.contains(method)) {
                colours[method] = colourFor(colours, mateMethods[method]);
            }
            const std::size_t colour = colours[method];
            looks[name] = {colour, shapeFor(looks, colour, mates[name]), variants[method]++};
        }
    }
    return looks;
}

}  // namespace hashphase::demos
