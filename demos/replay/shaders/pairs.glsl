// SPDX-License-Identifier: Zlib

#ifdef VERTEX

// A pair: a line from centre to centre, as wide in pixels however far away, and around the middle of a
// wrong one a ring.
uniform mat4 both;
uniform vec2 picture;   // [pixels]
uniform float pixels;   // of the screen's own in one of the page's
uniform vec3 pairColour;
uniform vec3 missingColour;
uniform vec3 extraColour;
uniform highp sampler2D lines;
out vec3 colour;
out vec2 onRing;
const float kRing = 11.0;
const float kLine = 1.5;
void main() {
    // Two texels each: from where and mark, to where.
    int index = gl_VertexID / 12;
    ivec2 place = ivec2(index % ITEMS_A_ROW * 2, index / ITEMS_A_ROW);
    vec4 first = texelFetch(lines, place, 0);
    vec3 from = first.xyz;
    vec3 to = texelFetch(lines, place + ivec2(1, 0), 0).xyz;
    float mark = first.w;
    bool isWrong = mark > 0.5;
    colour = !isWrong ? pairColour : mark > 1.5 ? missingColour : extraColour;
    int corner = int[6](0, 1, 2, 2, 1, 3)[gl_VertexID % 6];
    vec2 side = vec2(corner & 1, corner >> 1) * 2.0 - 1.0;
    vec4 a = both * vec4(from, 1.0);
    vec4 b = both * vec4(to, 1.0);
    if (gl_VertexID % 12 < 6) {
        onRing = side * 1.3;
        gl_Position = both * vec4(0.5 * (from + to), 1.0);
        gl_Position.xy += onRing * (isWrong ? kRing : 0.0) * pixels * 2.0 / picture * gl_Position.w;
        return;
    }
    onRing = vec2(-9.0);
    vec2 way = (b.xy / b.w - a.xy / a.w) * picture;
    vec2 across = length(way) > 0.0 ? normalize(vec2(-way.y, way.x)) : vec2(0.0, 1.0);
    gl_Position = side.x < 0.0 ? a : b;
    gl_Position.xy += across * side.y * (isWrong ? kLine : 0.5 * kLine) * pixels * 2.0 / picture * gl_Position.w;
}

#else

uniform vec3 halo;
in vec3 colour;
in vec2 onRing;
out vec4 pixel;
void main() {
    pixel = vec4(colour, 1.0);
    if (onRing.x > -5.0) {
        float radius = length(onRing);
        float soft = fwidth(radius);
        float ring = 1.0 - smoothstep(0.12, 0.12 + soft, abs(radius - 1.0));
        float around = 1.0 - smoothstep(0.22, 0.22 + soft, abs(radius - 1.0));
        pixel = vec4(mix(halo, colour, ring), max(ring, around * 0.7));
    }
}

#endif
