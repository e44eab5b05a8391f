// SPDX-License-Identifier: Zlib
#pragma once

// What all shaders share: a frame's uniforms, light and haze, and a theme's colours.

#include <demos/viewer/draw/gl_objects.hpp>
#include <demos/viewer/draw/view.hpp>

#include <string_view>

namespace hashphase::demos {

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

/// The uniform block `Frame`, in the layout of std140.
struct FrameUniforms {
    Eigen::Matrix4f clipFromWorld;
    Eigen::Vector4f eye;       // and the depth of the eye
    Eigen::Vector4f screen;    // width, height, focal length, least radius [pixels]
    Eigen::Vector4f up;        // of the camera, and the tangent vertically
    Eigen::Vector4f right;     // and the tangent horizontally
    Eigen::Vector4f forward;   // and one over the distance of full haze
    Eigen::Vector4f light;     // towards it, and the share of haze at most
    Eigen::Vector4f skyAbove;  // colours
    Eigen::Vector4f horizon;
    Eigen::Vector4f skyBelow;
    Eigen::Vector4f shadow;
};

/// `reach` is how far from the eye the world is worth seeing [m]: haze is complete there.
[[nodiscard]] FrameUniforms frameUniforms(const View& view, const ThemeColours& colours,
                                          float leastRadius, float reach);

inline constexpr GLuint kFrameBinding = 0;

/// GLSL: the block, and the functions shade(), shadeRound() and haze().
extern const std::string_view kFrameBlock;

}  // namespace hashphase::demos
