// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/palette.hpp>

#include <algorithm>
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

const std::array<Colour, 8>& qualitativeColours(Theme theme) {
    static constexpr std::array<Colour, 8> kLight{kBlue,    kOrange,    kGreen,  kPurple,
                                                  kSkyBlue, kVermilion, kYellow, kGrey};
    static constexpr std::array<Colour, 8> kDark{kSkyBlue,   kOrange,    kGreen,  kPurple,
                                                 kLightBlue, kVermilion, kYellow, kLightGrey};
    return theme == Theme::light ? kLight : kDark;
}

Colour sequentialColour(float share) {
    // Cividis at nine even steps; between them, colours are mixed.
    static constexpr std::array<Colour, 9> kSteps{{{0, 34, 78},
                                                   {26, 56, 111},
                                                   {67, 78, 108},
                                                   {97, 101, 110},
                                                   {125, 124, 120},
                                                   {156, 149, 119},
                                                   {189, 176, 108},
                                                   {224, 205, 88},
                                                   {254, 232, 56}}};
    const float place = std::clamp(share, 0.0F, 1.0F) * (kSteps.size() - 1);
    const auto lower = std::min(static_cast<std::size_t>(place), kSteps.size() - 2);
    const float weight = place - static_cast<float>(lower);
    const auto mix = [weight](std::uint8_t from, std::uint8_t to) {
        return static_cast<std::uint8_t>(
            std::lround(static_cast<float>(from) + weight * static_cast<float>(to - from)));
    };
    const Colour& a = kSteps[lower];
    const Colour& b = kSteps[lower + 1];
    return {mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue)};
}

}  // namespace hashphase::demos
