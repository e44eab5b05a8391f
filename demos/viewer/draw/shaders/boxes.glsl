// SPDX-License-Identifier: Zlib

#ifdef VERTEX

layout(location = 0) in vec3 middle;
layout(location = 1) in vec3 right;
layout(location = 2) in vec3 up;
layout(location = 3) in vec3 colourOfBox;

out vec2 onFace;       // from its middle, along both sides [m]
flat out vec2 widths;  // of its halves [m]
flat out vec4 tint;    // and the share of haze

void main() {
    vec2 corner = vec2(gl_VertexID & 1, (gl_VertexID >> 1) & 1) * 2.0 - 1.0;
    widths = vec2(length(right), length(up));
    onFace = corner * widths;
    vec3 normal = normalize(cross(right, up));
    tint = vec4(shade(colourOfBox, dot(normal, light.xyz)), haze(middle - eye.xyz));
    gl_Position = clipFromWorld * vec4(middle + corner.x * right + corner.y * up, 1.0);
}

#else

// Edges are a pixel and a half wide, and fade where the face is too small for them.
in vec2 onFace;
flat in vec2 widths;
flat in vec4 tint;

out vec4 colour;

void main() {
    vec2 pixel = max(fwidth(onFace), vec2(1e-9));
    vec2 fromEdge = (widths - abs(onFace)) / pixel;
    vec2 edges = clamp(2.0 - fromEdge, 0.0, 1.0) * clamp(widths / pixel * 0.2 - 0.5, 0.0, 1.0);
    vec3 lit = tint.rgb * (1.0 - 0.45 * max(edges.x, edges.y));
    colour = vec4(mix(lit, horizon.rgb, tint.a), 1.0);
}

#endif
