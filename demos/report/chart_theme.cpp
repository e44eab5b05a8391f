// SPDX-License-Identifier: Zlib
#include <demos/report/vega_lite.hpp>

namespace hashphase::demos {

// The colours of Okabe and Ito, "Color Universal Design", 2008, which people of any colour vision
// can tell apart; grey in place of their yellow, which is lost on white.
const ChartTheme& pictureTheme() {
    static const ChartTheme theme{
        "#222222",
        "#e3e3e3",
        "#ffffff",
        {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#666666"}};
    return theme;
}

const ChartTheme& pageTheme() {
    static const ChartTheme theme = [] {
        ChartTheme variables{"var(--ink)", "var(--faint)", "", {}};
        for (std::size_t i = 0; i < kSeriesColours; ++i) {
            variables.series[i] = "var(--series-" + std::to_string(i) + ")";
        }
        return variables;
    }();
    return theme;
}

}  // namespace hashphase::demos
