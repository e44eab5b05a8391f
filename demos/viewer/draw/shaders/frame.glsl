// SPDX-License-Identifier: Zlib
//
// Before each shader: what all of a frame share, light and haze.

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

// shade() is light from a wide, soft source: the darkest point is the one that looks straight away
// from it, not half of the body.
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
