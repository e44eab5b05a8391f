// SPDX-License-Identifier: Zlib
//
// What all objects have in common: their box, and their colour.
// Positions are relative to the low corner of the recorded bounds [m].

#ifdef VERTEX

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
    ivec2 at = ivec2(index % ITEMS_A_ROW * 2, index / ITEMS_A_ROW);
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
}

#endif
