// SPDX-License-Identifier: Zlib

#ifdef VERTEX

uniform vec4 corners;  // left, top, right, bottom [pixels]

out vec2 place;

void main() {
    int corner = int[6](0, 1, 2, 2, 1, 3)[gl_VertexID];
    place = vec2((corner & 1) == 0 ? corners.x : corners.z,
                 (corner & 2) == 0 ? corners.y : corners.w);
    vec2 share = place / screen.xy;
    gl_Position = vec4(2.0 * share.x - 1.0, 1.0 - 2.0 * share.y, 0.0, 1.0);
}

#else

in vec2 place;

uniform vec4 corners;
uniform vec3 tint;

out vec4 colour;

void main() {
    vec2 inside = min(place - corners.xy, corners.zw - place);
    bool isBorder = min(inside.x, inside.y) < 2.0;
    colour = vec4(tint, isBorder ? 0.95 : 0.16);
}

#endif
