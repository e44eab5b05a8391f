// SPDX-License-Identifier: Zlib

#ifdef VERTEX

// The screen in strips from the left to the right, whose vertices are coloured: the gradient is
// smooth enough for that, and a pixel costs half.
uniform ivec2 squares;

out vec3 seen;

void main() {
    int square = gl_VertexID / 6;
    int corner = gl_VertexID % 6;
    bool isRight = corner == 1 || corner == 4 || corner == 5;
    bool isAbove = corner == 2 || corner == 3 || corner == 5;
    ivec2 place = ivec2(square % squares.x, square / squares.x) + ivec2(isRight, isAbove);
    vec2 onScreen = 2.0 * vec2(place) / vec2(squares) - 1.0;
    vec3 direction = normalize(cameraForward.xyz + onScreen.x * cameraRight.w * cameraRight.xyz +
                               onScreen.y * cameraUp.w * cameraUp.xyz);
    float above = max(direction.y, 0.0);
    float below = max(-direction.y, 0.0);
    vec3 sky = mix(horizon.rgb, skyAbove.rgb, above * (2.0 - above));
    seen = mix(sky, skyBelow.rgb, min(4.0 * below, 1.0));
    gl_Position = vec4(onScreen, 1.0, 1.0);
}

#else

in vec3 seen;
out vec4 colour;

void main() {
    colour = vec4(seen, 1.0);
}

#endif
