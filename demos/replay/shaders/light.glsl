// SPDX-License-Identifier: Zlib

#ifndef VERTEX

vec3 lit(vec3 colour, vec3 normal) {
    float sun = max(dot(normal, normalize(vec3(0.35, 0.85, 0.4))), 0.0);
    float sky = 0.5 + 0.5 * normal.y;
    return colour * (0.42 + 0.22 * sky + 0.45 * sun);
}

#endif
