// SPDX-License-Identifier: Zlib
//
// GLSL of the replay. Positions are relative to the low corner of the recorded bounds [m].

const ITEMS_A_ROW = 1024; // of textures that hold two texels an item
const VERSION = "#version 300 es\nprecision highp float;\nprecision highp int;\n";

const BACKGROUND_VERTICES = `${VERSION}
out float height;
void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    height = corner.y * 0.5 + 0.5;
    gl_Position = vec4(corner, 1.0, 1.0);
}`;

const BACKGROUND_PIXELS = `${VERSION}
uniform vec3 top;
uniform vec3 bottom;
in float height;
out vec4 pixel;
void main() {
    // Less than a step of eight bits of noise hides that the gradient has steps.
    float noise = fract(sin(dot(gl_FragCoord.xy, vec2(12.9898, 78.233))) * 43758.5453) - 0.5;
    pixel = vec4(mix(bottom, top, smoothstep(0.0, 1.0, height)) + noise / 255.0, 1.0);
}`;

// What all objects have in common: their box, and their colour.
const OBJECT = `${VERSION}
uniform mat4 both;
uniform mat4 view;
uniform vec3 eye;
uniform vec3 extent;
uniform vec3 low;
uniform float groundEdge;     // so large is only what the others stand on [m]
uniform int colouring;        // 0 by cell, 1 by height, 2 by overlaps
uniform float cellSize;
uniform vec2 heights;         // lowest and highest
uniform vec3 cellColours[8];
uniform vec3 heightColours[5];
uniform vec3 overlapColours[5];
uniform vec3 missingColour;
uniform vec3 extraColour;
uniform vec3 dimColour;
uniform float dimming;        // of what is in no wrong pair
uniform float dimmingSingles; // of what is in no pair at all
uniform highp usampler2D objects;
vec3 centre;
vec3 edges;
float overlaps;
float mark;                   // 0, 1 extra, 2 missing

// Two texels each: centre and overlaps, edges and mark.
void readObject(int index) {
    ivec2 at = ivec2(index % ${ITEMS_A_ROW} * 2, index / ${ITEMS_A_ROW});
    uvec4 first = texelFetch(objects, at, 0);
    uvec4 second = texelFetch(objects, at + ivec2(1, 0), 0);
    centre = vec3(first.xyz) / 65535.0 * extent;
    edges = vec3(second.xyz) / 65535.0 * extent;
    overlaps = float(first.w);
    mark = float(second.w);
}

// Of the cell of the lowest corner. None of its 26 neighbours has the same: they are one step away in
// x, y or z, of which x counts one, z two, and y four of the eight colours.
vec3 colourOfCell(vec3 corner) {
    ivec3 cell = ivec3(floor(corner / cellSize));
    return cellColours[(cell.x + 2 * cell.z + 4 * cell.y) & 7];
}

vec3 along(vec3 colours[5], float share) {
    float at = clamp(share, 0.0, 1.0) * 4.0;
    int below = min(int(at), 3);
    return mix(colours[below], colours[below + 1], at - float(below));
}

vec3 colourOf() {
    if (mark > 0.5) {
        return mark > 1.5 ? missingColour : extraColour;
    }
    vec3 colour = colouring == 0 ? colourOfCell(low + centre - 0.5 * edges)
        : colouring == 1 ? along(heightColours, (centre.y - heights.x) / (heights.y - heights.x))
        : along(overlapColours, min(overlaps, 8.0) / 8.0);
    if (max(edges.x, edges.z) > groundEdge) {
        colour = dimColour;
    }
    return mix(colour, dimColour, overlaps > 0.0 ? dimming : dimmingSingles);
}`;

// Of a box, the three faces that look at the camera: six vertices each.
const BOX_VERTICES = `${OBJECT}
out vec3 colour;
out vec2 onFace;
flat out vec3 normal;
void main() {
    readObject(gl_VertexID / 18);
    int axis = gl_VertexID % 18 / 6;
    int corner = int[6](0, 1, 2, 2, 1, 3)[gl_VertexID % 6];
    onFace = vec2(corner & 1, corner >> 1);
    normal = vec3(0);
    normal[axis] = eye[axis] < centre[axis] ? -1.0 : 1.0;
    vec3 at = normal;
    at[(axis + 1) % 3] = onFace.x * 2.0 - 1.0;
    at[(axis + 2) % 3] = onFace.y * 2.0 - 1.0;
    colour = colourOf();
    gl_Position = both * vec4(centre + 0.5 * edges * at, 1.0);
}`;

const LIGHT = `
vec3 lit(vec3 colour, vec3 normal) {
    float sun = max(dot(normal, normalize(vec3(0.35, 0.85, 0.4))), 0.0);
    float sky = 0.5 + 0.5 * normal.y;
    return colour * (0.42 + 0.22 * sky + 0.45 * sun);
}`;

const BOX_PIXELS = `${VERSION}
uniform float opacity;
in vec3 colour;
in vec2 onFace;
flat in vec3 normal;
out vec4 pixel;
${LIGHT}
void main() {
    vec2 width = fwidth(onFace);
    vec2 fromEdge = min(onFace, 1.0 - onFace) / max(width, 1e-6);
    float edge = 1.0 - smoothstep(0.5, 1.5, min(fromEdge.x, fromEdge.y));
    edge *= 1.0 - smoothstep(0.05, 0.2, max(width.x, width.y)); // not where a face is but edges
    pixel = vec4(lit(colour, normal) * (1.0 - 0.35 * edge), opacity);
}`;

// A square that faces the camera; the sphere on it is found pixel by pixel.
const SPHERE_VERTICES = `${OBJECT}
uniform mat4 projection;
out vec3 colour;
out vec2 onSquare;
out vec3 viewCentre;
flat out float radius;
void main() {
    readObject(gl_VertexID / 6);
    int corner = int[6](0, 1, 2, 2, 1, 3)[gl_VertexID % 6];
    onSquare = vec2(corner & 1, corner >> 1) * 2.0 - 1.0;
    radius = 0.5 * max(edges.x, max(edges.y, edges.z));
    viewCentre = (view * vec4(centre, 1.0)).xyz;
    colour = colourOf();
    gl_Position = projection * vec4(viewCentre + vec3(onSquare * radius, 0.0), 1.0);
}`;

const SPHERE_PIXELS = `${VERSION}
uniform mat4 view;
uniform mat4 projection;
uniform float opacity;
in vec3 colour;
in vec2 onSquare;
in vec3 viewCentre;
flat in float radius;
out vec4 pixel;
${LIGHT}
void main() {
    float squared = dot(onSquare, onSquare);
    float border = fwidth(squared);
    float cover = 1.0 - smoothstep(1.0 - border, 1.0, squared);
    if (squared > 1.0) {
        discard;
    }
    vec3 outward = vec3(onSquare, sqrt(1.0 - squared));
    vec4 place = projection * vec4(viewCentre + outward * radius, 1.0);
    gl_FragDepth = 0.5 + 0.5 * place.z / place.w;
    vec3 normal = outward * mat3(view); // back to the world's axes
    pixel = vec4(lit(colour, normal) * (0.75 + 0.25 * outward.z), opacity * cover);
}`;

// A pair: a line from centre to centre, as wide in pixels however far away, and around the middle of a
// wrong one a ring.
const PAIR_VERTICES = `${VERSION}
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
    ivec2 place = ivec2(index % ${ITEMS_A_ROW} * 2, index / ${ITEMS_A_ROW});
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
}`;

const PAIR_PIXELS = `${VERSION}
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
}`;
