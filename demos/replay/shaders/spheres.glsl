// SPDX-License-Identifier: Zlib

#ifdef VERTEX

// A square that faces the camera; the sphere on it is found pixel by pixel.
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
}

#else

uniform mat4 view;
uniform mat4 projection;
uniform float opacity;
in vec3 colour;
in vec2 onSquare;
in vec3 viewCentre;
flat in float radius;
out vec4 pixel;
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
}

#endif
