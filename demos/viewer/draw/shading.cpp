// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/shading.hpp>

#include <algorithm>

namespace hashphase::demos {

namespace {

Eigen::Vector4f join(const Vector3<float>& vector, float last = 1) {
    return {vector.x(), vector.y(), vector.z(), last};
}

constexpr float kHazeOfFarPlane = 0.98F;  // haze is complete just before the world is cut off

}  // namespace

// shade() is light from a wide, soft source: the darkest point is the one that looks straight away
// from it, not half of the body.
const std::string_view kFrameBlock = R"glsl(
layout(std140) uniform Frame {
    mat4 clipFromWorld;
    vec4 eye;
    vec4 screen;
    vec4 cameraUp;
    vec4 cameraRight;
    vec4 cameraForward;
    vec4 light;
    vec4 skyAbove;
    vec4 horizon;
    vec4 skyBelow;
    vec4 shadow;
};

// `towardsLight` is the cosine of the angle between the surface's normal and the light.
vec3 shade(vec3 colour, float towardsLight) {
    float brightness = 0.5 + 0.5 * towardsLight;
    brightness *= brightness;
    return mix(colour * shadow.rgb, colour, min(brightness * 1.1, 1.0));
}

// What is round shows the source of the light.
vec3 shadeRound(vec3 colour, float towardsLight) {
    float gleam = max(towardsLight, 0.0);
    gleam *= gleam;
    gleam *= gleam;
    return mix(shade(colour, towardsLight), vec3(1.0), 0.2 * gleam);
}

// Share of haze before what is so far from the eye. Who looks down looks through little of it.
float haze(vec3 fromEye) {
    float distance = length(fromEye);
    float share = distance * cameraForward.w;
    float level = 1.0 - abs(fromEye.y) / distance;
    return light.w * min(share * share, 1.0) * min(level * 1.6, 1.0);
}
)glsl";

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

FrameUniforms frameUniforms(const View& view, const ThemeColours& colours, float leastRadius,
                            float reach) {
    const float hazeDistance = std::min(kHazeOfFarPlane * view.farPlane, reach);
    const Vector3<float> towardsLight = Vector3<float>(0.38F, 0.86F, 0.34F).normalized();
    return {.clipFromWorld = view.clipFromWorld,
            .eye = join(view.eye, view.eyeDepth),
            .screen = {view.size.x(), view.size.y(), view.focalLength, leastRadius},
            .up = join(view.up, view.tangents.y()),
            .right = join(view.right, view.tangents.x()),
            .forward = join(view.forward, 1 / hazeDistance),
            .light = join(towardsLight, colours.hazeAtMost),
            .skyAbove = join(colours.skyAbove),
            .horizon = join(colours.horizon),
            .skyBelow = join(colours.skyBelow),
            .shadow = join(colours.shadow)};
}

}  // namespace hashphase::demos
