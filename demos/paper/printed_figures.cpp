// SPDX-License-Identifier: Zlib
#include <demos/paper/printed_figures.hpp>

#include <algorithm>
#include <charconv>

namespace hashphase::demos {
namespace {

// Rows by kPrintedObjects; un-optimized, then by kPrintedCellSizes.
using PrintedRows = std::array<std::array<std::string_view, 6>, 7>;

constexpr PrintedRows kFigure13{{{"60+", "60+", "60+", "60+", "60+", "60+"},
                                 {"60+", "60+", "60+", "60+", "60+", "60+"},
                                 {"25", "60+", "60+", "60+", "60+", "60+"},
                                 {"<1", "60+", "60+", "60+", "60+", "60+"},
                                 {"<1", "60+", "60+", "60+", "60+", "2"},
                                 {"<1", "60+", "60+", "50", "5", "<1"},
                                 {"<1", "29", "23", "<1", "<1", "<1"}}};

constexpr PrintedRows kFigure14{{{"60+", "60+", "60+", "60+", "60+", "60+"},
                                 {"60+", "60+", "60+", "60+", "60+", "60+"},
                                 {"48", "60+", "60+", "60+", "60+", "60+"},
                                 {"16", "60+", "60+", "60+", "60+", "60+"},
                                 {"<1", "60+", "60+", "60+", "60+", "60+"},
                                 {"<1", "60+", "60+", "60+", "60", "49"},
                                 {"<1", "60+", "60+", "60+", "52", "40"}}};

// The last one is printed as "<!".
constexpr PrintedRows kFigure15{{{"60+", "60+", "60+", "60+", "60+", "60+"},
                                 {"60+", "60+", "60+", "60+", "60+", "60+"},
                                 {"35", "60+", "60+", "60+", "60+", "60+"},
                                 {"<1", "60+", "60+", "60+", "60+", "60+"},
                                 {"<1", "60+", "60+", "24", "33", "10"},
                                 {"<1", "23", "28", "12", "<1", "<1"},
                                 {"<1", "8", "<1", "<1", "<1", "<1"}}};

struct PrintedFigure {
    int number;
    std::string_view name;
    std::string_view paperScope;
    std::string_view scope;
    const PrintedRows& rows;
};

const PrintedFigure& figureOf(Phase phase) {
    static constexpr std::array<PrintedFigure, 3> kFigures{{
        {13, "collision", "collision between all spheres, response and terrain traversal",
         "hashing all spheres anew, all overlapping pairs, which of them touch and how they "
         "bounce, "
         "and the ground below each",
         kFigure13},
        {14, "visibility", "frustum culling and the draw calls of all visible objects",
         "hashing all spheres anew, and the list of those that a free camera sees; nothing is "
         "drawn",
         kFigure14},
        {15, "AI", "every object counts the colours within a radius and takes the rarest",
         "hashing all spheres anew, counting the colours within the radius of each, and taking the "
         "rarest; hashphase counts in cells that follow the radius, whatever the column",
         kFigure15},
    }};
    return kFigures[static_cast<std::size_t>(phase)];
}

}  // namespace

int figureNumber(Phase phase) {
    return figureOf(phase).number;
}

std::string_view nameOf(Phase phase) {
    return figureOf(phase).name;
}

std::string_view scopeOf(Phase phase) {
    return figureOf(phase).scope;
}

std::string_view paperScope(Phase phase) {
    return figureOf(phase).paperScope;
}

std::string_view printedRate(Phase phase, std::uint32_t objects, std::optional<double> cellSize) {
    const auto* const row = std::find(kPrintedObjects.begin(), kPrintedObjects.end(), objects);
    const auto* const cell =
        cellSize ? std::find(kPrintedCellSizes.begin(), kPrintedCellSizes.end(), *cellSize)
                 : kPrintedCellSizes.end();
    if (row == kPrintedObjects.end() || (cellSize && cell == kPrintedCellSizes.end())) {
        return {};
    }
    const std::size_t column =
        cellSize ? static_cast<std::size_t>(1 + cell - kPrintedCellSizes.begin()) : 0;
    return figureOf(phase).rows[static_cast<std::size_t>(row - kPrintedObjects.begin())][column];
}

std::optional<double> exactRate(std::string_view printed) {
    int rate = 0;
    const char* const end = printed.data() + printed.size();
    const auto [read, fault] = std::from_chars(printed.data(), end, rate);
    if (fault != std::errc() || read != end) {
        return std::nullopt;
    }
    return rate;
}

bool isTooSlow(std::string_view printed) {
    const std::optional<double> rate = exactRate(printed);
    return printed == "<1" || (rate && *rate < kRealTimeRate);
}

}  // namespace hashphase::demos
