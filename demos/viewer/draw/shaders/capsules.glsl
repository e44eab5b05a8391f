// SPDX-License-Identifier: Zlib

#ifdef VERTEX

// The far sides of a box around the capsule: they are seen from inside as well.
layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;
layout(location = 2) in float radiusOfCapsule;
layout(location = 3) in vec4 colourOfCapsule;

out vec3 ray;                // from the eye, of any length
flat out vec3 start;         // from the eye to an end
flat out vec3 along;         // from there to the other end
flat out vec2 radiusAndHaze;
flat out vec4 tint;

const int kCorners[36] = int[36](0, 2, 1, 1, 2, 3, 4, 5, 6, 6, 5, 7, 0, 1, 4, 4, 1, 5,
                                 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 5, 3, 7);

void main() {
    start = from - eye.xyz;
    along = to - from;
    float length = length(along);
    vec3 z = length > 0.0 ? along / length : vec3(0.0, 0.0, 1.0);
    vec3 x = normalize(cross(z, abs(z.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0)));
    vec3 y = cross(z, x);
    vec3 middle = start + 0.5 * along;
    float pixel = max(dot(middle, cameraForward.xyz), 0.0) / screen.z;
    float radius = max(radiusOfCapsule, screen.w * pixel);

    int corner = kCorners[gl_VertexID];
    vec3 side = vec3(corner & 1, (corner >> 1) & 1, corner >> 2) * 2.0 - 1.0;
    float wide = radius + pixel;
    ray = middle + wide * (side.x * x + side.y * y) + (0.5 * length + wide) * side.z * z;
    gl_Position = clipFromWorld * vec4(eye.xyz + ray, 1.0);
    radiusAndHaze = vec2(radius, haze(middle));
    tint = colourOfCapsule;
}

#else

// How near the ray comes to the axis says how much of the pixel is covered; where the ray first is
// a radius away from the axis, it meets the capsule.
in vec3 ray;
flat in vec3 start;
flat in vec3 along;
flat in vec2 radiusAndHaze;
flat in vec4 tint;

out vec4 colour;

// The share of the axis that is nearest to the ray, and of the axis to the point.
float axisShare(vec3 place) {
    return clamp(dot(place - start, along) / max(dot(along, along), 1e-12), 0.0, 1.0);
}

float nearestShare(vec3 direction) {
    vec3 acrossAlong = along - direction * dot(along, direction);
    vec3 acrossStart = start - direction * dot(start, direction);
    return clamp(-dot(acrossStart, acrossAlong) / max(dot(acrossAlong, acrossAlong), 1e-12), 0.0,
                 1.0);
}

// Where the ray enters the sphere around the point, or a far away place.
float enterSphere(vec3 centre, vec3 direction, float radius) {
    float middle = dot(centre, direction);
    vec3 across = centre - direction * middle;
    float discriminant = radius * radius - dot(across, across);
    return discriminant < 0.0 ? 1e30 : middle - sqrt(discriminant);
}

// Where the ray enters the side of the cylinder, between its ends, or a far away place.
float enterSide(vec3 direction, float radius) {
    float squared = dot(along, along);
    float slant = dot(along, direction);
    float ahead = dot(along, start);
    float a = squared - slant * slant;
    float b = squared * dot(start, direction) - ahead * slant;
    float c = squared * dot(start, start) - ahead * ahead - radius * radius * squared;
    float discriminant = b * b - a * c;
    if (a <= 0.0 || discriminant < 0.0) {
        return 1e30;
    }
    float t = (b - sqrt(discriminant)) / a;
    float share = (t * slant - ahead) / squared;
    return share < 0.0 || share > 1.0 ? 1e30 : t;
}

void main() {
    vec3 direction = normalize(ray);
    float radius = radiusAndHaze.x;
    vec3 nearest = start + along * nearestShare(direction);
    float middle = dot(nearest, direction);
    float away = length(nearest - direction * middle);
    float pixel = middle / (screen.z * dot(direction, cameraForward.xyz));
    float coverage = min((radius - away) / pixel + 0.5, 1.0);
    if (coverage <= 0.0 || middle <= 0.0) {
        discard;
    }
    float t = min(enterSide(direction, radius),
                  min(enterSphere(start, direction, radius),
                      enterSphere(start + along, direction, radius)));
    t = t < 1e29 ? t : middle;
    vec3 place = direction * t;
    vec3 normal = normalize(place - start - along * axisShare(place));
    vec3 lit = shadeRound(tint.rgb, dot(normal, light.xyz));
    colour = vec4(mix(lit, horizon.rgb, radiusAndHaze.y), tint.a * coverage);
    vec4 clip = clipFromWorld * vec4(eye.xyz + place, 1.0);
    gl_FragDepth = 0.5 + 0.5 * clip.z / clip.w;
}

#endif
