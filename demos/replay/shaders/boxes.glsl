// SPDX-License-Identifier: Zlib

#ifdef VERTEX

// Of a box, the three faces that look at the camera: six vertices each.
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
}

#else

uniform float opacity;
in vec3 colour;
in vec2 onFace;
flat in vec3 normal;
out vec4 pixel;
void main() {
    vec2 width = fwidth(onFace);
    vec2 fromEdge = min(onFace, 1.0 - onFace) / max(width, 1e-6);
    float edge = 1.0 - smoothstep(0.5, 1.5, min(fromEdge.x, fromEdge.y));
    edge *= 1.0 - smoothstep(0.05, 0.2, max(width.x, width.y)); // not where a face is but edges
    pixel = vec4(lit(colour, normal) * (1.0 - 0.35 * edge), opacity);
}

#endif
