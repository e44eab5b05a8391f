// SPDX-License-Identifier: Zlib

#ifdef VERTEX

// Of each square of the lattice two triangles, seen counterclockwise from above. The lattice covers the recorded
// bounds in x and z; positions are relative to their low corner [m].
uniform mat4 both;
uniform vec3 extent;
uniform vec2 heightRange;         // the lowest and the highest
uniform highp sampler2D heights;  // of the lattice's points: 0 for the lowest, 1 for the highest
out vec3 normal;

// Beyond the lattice: its nearest point.
vec3 pointAt(ivec2 at) {
    ivec2 last = textureSize(heights, 0) - 1;
    at = clamp(at, ivec2(0), last);
    vec2 place = vec2(at) / vec2(last) * extent.xz;
    return vec3(place.x, mix(heightRange.x, heightRange.y, texelFetch(heights, at, 0).r), place.y);
}

void main() {
    int squares = textureSize(heights, 0).x - 1;
    int square = gl_VertexID / 6;
    int corner = int[6](0, 2, 1, 1, 2, 3)[gl_VertexID % 6];
    ivec2 at = ivec2(square % squares, square / squares) + ivec2(corner & 1, corner >> 1);
    vec3 alongX = pointAt(at + ivec2(1, 0)) - pointAt(at - ivec2(1, 0));
    vec3 alongZ = pointAt(at + ivec2(0, 1)) - pointAt(at - ivec2(0, 1));
    normal = cross(alongZ, alongX);
    gl_Position = both * vec4(pointAt(at), 1.0);
}

#else

uniform vec3 groundColour;
in vec3 normal;
out vec4 pixel;
void main() {
    // Hills are lit as if they were three times as steep: gentle ones would look flat.
    pixel = vec4(lit(groundColour, normalize(normal * vec3(3.0, 1.0, 3.0))), 1.0);
}

#endif
