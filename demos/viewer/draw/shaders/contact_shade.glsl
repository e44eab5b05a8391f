// SPDX-License-Identifier: Zlib

#ifdef VERTEX

// A square in the plane of the ground. It comes nearer to the eye by a part of its radius, which
// moves nothing on the screen, and so it is not swallowed by ground that bulges.
layout(location = 0) in vec4 spot;
layout(location = 1) in vec4 ground;

out vec2 offset;
flat out float strength;

void main() {
    offset = vec2(gl_VertexID & 1, (gl_VertexID >> 1) & 1) * 2.0 - 1.0;
    vec3 right = normalize(vec3(ground.y, -ground.x, 0.0));
    vec3 ahead = cross(right, ground.xyz);
    vec3 place = spot.xyz + spot.w * (right * offset.x + ahead * offset.y);
    vec3 towardsEye = normalize(eye.xyz - place);
    gl_Position = clipFromWorld * vec4(place + 0.35 * spot.w * towardsEye, 1.0);
    strength = ground.w * (1.0 - haze(spot.xyz - eye.xyz));
}

#else

in vec2 offset;
flat in float strength;

out vec4 colour;

void main() {
    float inside = max(1.0 - dot(offset, offset), 0.0);
    colour = vec4(shadow.rgb * 0.3, strength * inside * inside);
}

#endif
