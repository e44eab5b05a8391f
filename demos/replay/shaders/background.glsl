// SPDX-License-Identifier: Zlib

#ifdef VERTEX

out float height;
void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    height = corner.y * 0.5 + 0.5;
    gl_Position = vec4(corner, 1.0, 1.0);
}

#else

uniform vec3 top;
uniform vec3 bottom;
in float height;
out vec4 pixel;
void main() {
    // Less than a step of eight bits of noise hides that the gradient has steps.
    float noise = fract(sin(dot(gl_FragCoord.xy, vec2(12.9898, 78.233))) * 43758.5453) - 0.5;
    pixel = vec4(mix(bottom, top, smoothstep(0.0, 1.0, height)) + noise / 255.0, 1.0);
}

#endif
