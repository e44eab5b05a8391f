// SPDX-License-Identifier: Zlib
#include <demos/report/chart_labels.hpp>

#include <algorithm>
#include <array>

namespace hashphase::demos {
namespace {

constexpr double kLetterWidth = 6;  // [px], of a text of 11
constexpr double kHeight = 12;
constexpr double kPointRadius = 4;

constexpr std::array<LabelPlace, 8> kPlaces{{{"left", 7, -7},
                                             {"right", -7, -7},
                                             {"left", 7, 8},
                                             {"right", -7, 8},
                                             {"center", 0, -12},
                                             {"center", 0, 13},
                                             {"left", 9, 0},
                                             {"right", -9, 0}}};

struct Box {
    double left, top, right, bottom;
};

Box boxOf(const LabelledPoint& point, const LabelPlace& place) {
    const double width = kLetterWidth * static_cast<double>(point.label.size());
    const double shift = place.align[0] == 'l' ? 0 : place.align[0] == 'r' ? -width : -width / 2;
    const double left = point.x + place.dx + shift;
    const double middle = point.y + place.dy;
    return {left, middle - kHeight / 2, left + width, middle + kHeight / 2};
}

double sharedArea(const Box& a, const Box& b) {
    const double width = std::min(a.right, b.right) - std::max(a.left, b.left);
    const double height = std::min(a.bottom, b.bottom) - std::max(a.top, b.top);
    return width > 0 && height > 0 ? width * height : 0;
}

}  // namespace

std::vector<LabelPlace> placeLabels(std::span<const LabelledPoint> points, double width) {
    // What is beyond the sides counts as taken.
    constexpr double kFar = 1e6;
    std::vector<Box> taken{{-kFar, -kFar, 0, kFar}, {width, -kFar, kFar, kFar}};
    for (const LabelledPoint& point : points) {
        taken.push_back({point.x - kPointRadius, point.y - kPointRadius, point.x + kPointRadius,
                         point.y + kPointRadius});
    }
    std::vector<LabelPlace> places;
    for (const LabelledPoint& point : points) {
        const auto hidden = [&](const LabelPlace& place) {
            double area = 0;
            for (const Box& box : taken) {
                area += sharedArea(boxOf(point, place), box);
            }
            return area;
        };
        std::array<double, kPlaces.size()> areas{};
        std::transform(kPlaces.begin(), kPlaces.end(), areas.begin(), hidden);
        const auto best = std::min_element(areas.begin(), areas.end()) - areas.begin();
        places.push_back(kPlaces[static_cast<std::size_t>(best)]);
        if (!point.label.empty()) {
            taken.push_back(boxOf(point, places.back()));
        }
    }
    return places;
}

}  // namespace hashphase::demos
