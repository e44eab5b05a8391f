// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/palette.hpp>

#include <integration/bullet/detail/sequential_ramp.hpp>

#include <cmath>

namespace hashphase::demos {

namespace {

// Okabe and Ito's colours. On a dark ground blue is lightened, and black becomes white.
constexpr Colour kOrange{230, 159, 0};
constexpr Colour kSkyBlue{86, 180, 233};
constexpr Colour kGreen{0, 158, 115};
constexpr Colour kYellow{240, 228, 66};
constexpr Colour kBlue{0, 114, 178};
constexpr Colour kLightBlue{64, 148, 214};
constexpr Colour kVermilion{213, 94, 0};
constexpr Colour kPurple{204, 121, 167};
constexpr Colour kGrey{96, 104, 116};
constexpr Colour kLightGrey{168, 178, 190};

}  // namespace

const Palette& palette(Theme theme) {
    static const Palette kLight{.calm = kBlue,
                                .awake = kSkyBlue,
                                .selected = kYellow,
                                .picked = kVermilion,
                                .accent = {30, 34, 42},
                                .contrast = {252, 252, 252},
                                .fixed = {168, 177, 190},
                                .line = {36, 44, 58, 230},
                                .alert = {200, 40, 20},
                                .warning = kOrange,
                                .confirmed = kGreen,
                                .unknown = kLightGrey};
    static const Palette kDark{.calm = kLightBlue,
                               .awake = kSkyBlue,
                               .selected = kYellow,
                               .picked = {255, 122, 40},
                               .accent = {240, 240, 244},
                               .contrast = {16, 18, 24},
                               .fixed = {150, 164, 186},
                               .line = {226, 232, 242, 230},
                               .alert = {255, 92, 70},
                               .warning = kOrange,
                               .confirmed = {40, 190, 146},
                               .unknown = kLightGrey};
    return theme == Theme::light ? kLight : kDark;
}

const ThemeColours& themeColours(Theme theme) {
    static const ThemeColours kLight{.skyAbove = {0.36F, 0.57F, 0.82F},
                                     .horizon = {0.87F, 0.91F, 0.94F},
                                     .skyBelow = {0.72F, 0.74F, 0.74F},
                                     .meadow = {0.71F, 0.76F, 0.63F},
                                     .summit = {0.88F, 0.86F, 0.77F},
                                     .slope = {0.66F, 0.61F, 0.52F},
                                     .shadow = {0.42F, 0.45F, 0.55F},
                                     .hazeAtMost = 0.95F};
    static const ThemeColours kDark{.skyAbove = {0.035F, 0.045F, 0.085F},
                                    .horizon = {0.16F, 0.19F, 0.26F},
                                    .skyBelow = {0.06F, 0.065F, 0.08F},
                                    .meadow = {0.155F, 0.19F, 0.21F},
                                    .summit = {0.27F, 0.30F, 0.33F},
                                    .slope = {0.13F, 0.14F, 0.18F},
                                    .shadow = {0.30F, 0.32F, 0.42F},
                                    .hazeAtMost = 0.9F};
    return theme == Theme::light ? kLight : kDark;
}

const std::array<Colour, 8>& qualitativeColours(Theme theme) {
    static constexpr std::array<Colour, 8> kLight{kBlue,    kOrange,    kGreen,  kPurple,
                                                  kSkyBlue, kVermilion, kYellow, kGrey};
    static constexpr std::array<Colour, 8> kDark{kSkyBlue,   kOrange,    kGreen,  kPurple,
                                                 kLightBlue, kVermilion, kYellow, kLightGrey};
    return theme == Theme::light ? kLight : kDark;
}

Colour kindColour(Theme theme, std::size_t kind) {
    // Searched for, one after the other, as those that are farthest in CIELAB from all before and from black and
    // white, as seen with and without deuteranopia and protanopia.
    static constexpr std::array<Colour, 8> kMore{{{40, 40, 230},
                                                  {192, 230, 154},
                                                  {154, 40, 40},
                                                  {40, 40, 154},
                                                  {78, 40, 97},
                                                  {59, 116, 230},
                                                  {230, 192, 97},
                                                  {116, 40, 59}}};
    const std::array<Colour, 8>& first = qualitativeColours(theme);
    static_assert(kMostKinds == 8 + kMore.size());
    return kind < first.size() ? first[kind]
                               : kMore[std::min(kind - first.size(), kMore.size() - 1)];
}

Colour sequentialColour(float share) {
    const auto [red, green, blue] = detail::sequentialRgb(share);
    const auto rounded = [](float value) { return static_cast<std::uint8_t>(std::lround(value)); };
    return {rounded(red), rounded(green), rounded(blue)};
}

}  // namespace hashphase::demos
