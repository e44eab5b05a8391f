// SPDX-License-Identifier: Zlib
#pragma once

// Colours that people can tell apart whatever they see of red and green.
//
// The qualitative colours follow M. Okabe and K. Ito, "Color Universal Design", 2008; for the
// sequential ones see integration/bullet/detail/sequential_ramp.hpp.

#include <demos/viewer/draw/picture.hpp>

#include <array>
#include <cstddef>

namespace hashphase::demos {

/// To tell kinds of things apart; on the theme's ground and sky.
struct Palette {
    Colour calm;       // what is as it always is: the many
    Colour awake;      // the same, in motion
    Colour selected;   // by the user
    Colour picked;     // the one under the pointer
    Colour accent;     // what the user has marked
    Colour contrast;   // the opposite of accent
    Colour fixed;      // what never moves
    Colour line;       // thin lines that must be seen
    Colour alert;      // what is wrong
    Colour warning;    // what may be wrong
    Colour confirmed;  // what was checked and is right
    Colour unknown;    // what is to be checked
};

[[nodiscard]] const Palette& palette(Theme theme);

/// What a theme paints the world with.
struct ThemeColours {
    Vector3<float> skyAbove;  // straight up
    Vector3<float> horizon;   // and what haze fades to
    Vector3<float> skyBelow;  // straight down, where there is no ground
    Vector3<float> meadow;    // ground that lies level, in the lowlands
    Vector3<float> summit;    // in the highlands
    Vector3<float> slope;     // ground that is steep
    Vector3<float> shadow;    // what the dark side of things turns to
    float hazeAtMost;         // share of the haze at the far plane
};

[[nodiscard]] const ThemeColours& themeColours(Theme theme);

/// Eight kinds, in the order in which they are best taken.
[[nodiscard]] const std::array<Colour, 8>& qualitativeColours(Theme theme);

inline constexpr std::size_t kMostKinds = 16;

/// A colour for each of kMostKinds kinds, on the panel: qualitativeColours() first. Kinds beyond share the last one.
[[nodiscard]] Colour kindColour(Theme theme, std::size_t kind);

/// From dark blue for 0 to yellow for 1; what lies outside is as what is nearest.
[[nodiscard]] Colour sequentialColour(float share);

/// As shaders have it, from 0 to 1.
[[nodiscard]] inline Vector3<float> asVector(Colour colour) {
    return Vector3<float>(colour.red, colour.green, colour.blue) / 255;
}

}  // namespace hashphase::demos
