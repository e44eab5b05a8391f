// SPDX-License-Identifier: Zlib

#ifdef VERTEX

// A line comes a little nearer, so that it is seen on the surface it lies in. Its direction on the
// screen is found without a division, because an end may lie beside the eye or behind it.
// (`noperspective` would say in a word what acrossTimesW says, but Mesa 22's software rendering
// drops lines that use it and are clipped.)
layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;
layout(location = 2) in vec4 colourOfLine;

const float kHalfWidth = 0.8;  // [pixels]
const float kNearer = 0.002;

out float acrossTimesW;  // from the middle of the line [pixels]; so divided by w, it is linear
flat out vec4 tint;

void main() {
    // Nearer to the eye by a part of the distance, or surfaces would swallow the lines on them.
    vec4 start = clipFromWorld * vec4(mix(from, eye.xyz, kNearer), 1.0);
    vec4 end = clipFromWorld * vec4(mix(to, eye.xyz, kNearer), 1.0);
    vec2 way = (end.xy * start.w - start.xy * end.w) * screen.xy;
    vec2 aside = normalize(dot(way, way) > 0.0 ? vec2(-way.y, way.x) : vec2(1.0, 0.0));
    float side = float(gl_VertexID & 1) * 2.0 - 1.0;
    vec4 place = (gl_VertexID & 2) == 0 ? start : end;
    float across = side * (kHalfWidth + 0.5);
    place.xy += 2.0 * across * aside / screen.xy * place.w;
    acrossTimesW = across * place.w;
    gl_Position = place;
    tint = colourOfLine;
}

#else

in float acrossTimesW;
flat in vec4 tint;

uniform float opacity;

out vec4 colour;

void main() {
    float across = acrossTimesW * gl_FragCoord.w;
    float coverage = clamp(1.3 - abs(across), 0.0, 1.0);
    colour = vec4(tint.rgb, tint.a * coverage * opacity);
}

#endif
