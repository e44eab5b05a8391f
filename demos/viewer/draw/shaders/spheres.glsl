// SPDX-License-Identifier: Zlib
//
// QUADS, POINTS or DOTS is defined.
//
// From the eye, a sphere of radius 1 at distance D = 1 / s is the cone around the circle in which
// rays touch it: radius c = sqrt(1 - s^2), s nearer to the eye than the centre. The quad lies in
// the plane of that circle, so its edge is exactly the sphere's in any perspective: |offset| = 1
// there.
//
// The ray through c * offset on that plane meets the sphere at D / (D + h) of the way to the plane,
// where h = sqrt(1 - |offset|^2). With the axis towards the eye, the normal there is (c * offset, s
// + h) / (1 + s * h), and the depth is what the plane's is, and s * h times the eye's depth before
// the division by w, divided by the plane's w.
//
// A small sphere is a point, whose square is a primitive instead of two and a vertex instead of
// four, which is what costs. There s is next to nothing, and offset a linear function of the pixel.
//
// A tiny one is a dot: a disc before it, shaded like a sphere by fewer steps for each pixel.

#ifdef VERTEX

layout(location = 0) in vec4 sphere;
layout(location = 1) in vec4 colourOfSphere;

flat out vec4 tint;
flat out vec4 lightInQuad;  // towards the light, in the axes of the quad; and the share of haze
flat out vec4 shape;        // s, c, the radius on the screen [pixels], the eye's depth times s

vec3 axis;   // from the eye
vec3 right;  // of the quad
vec3 up;
float distance;
float depth;
float radius;

void placeSphere() {
    vec3 fromEye = sphere.xyz - eye.xyz;
    depth = dot(fromEye, cameraForward.xyz);
    radius = max(sphere.w, screen.w * depth / screen.z);
    distance = length(fromEye);
    axis = fromEye / distance;
    right = normalize(cross(axis, cameraUp.xyz));
    up = cross(right, axis);
    float s = min(radius / distance, 0.999);
    tint = colourOfSphere;
    lightInQuad = vec4(dot(right, light.xyz), dot(up, light.xyz), -dot(axis, light.xyz),
                       haze(fromEye));
    shape = vec4(s, sqrt(1.0 - s * s), screen.z * radius / depth, eye.w * s);
}

#ifdef QUADS

out vec2 offset;

void main() {
    placeSphere();
    vec2 corner = vec2(gl_VertexID & 1, (gl_VertexID >> 1) & 1) * 2.0 - 1.0;
    offset = corner * (1.0 + 0.5 / shape.z);
    vec3 place = eye.xyz + axis * (distance - radius * shape.x) +
                 radius * shape.y * (right * offset.x + up * offset.y);
    gl_Position = clipFromWorld * vec4(place, 1.0);
}

#else

flat out vec3 offsetOfPlace;  // x by x, y by x, y by y; x does not depend on y
#ifdef DOTS
flat out vec4 dark;    // colour away from the light
flat out vec4 bright;  // what is added to it towards the light; and the brightness of the gleam
flat out vec3 slope;   // of the brightness, in right, up and towards the eye
#endif

void main() {
    placeSphere();
    // Away from the middle of the screen, spheres are drawn out by one over the cosine.
    float size = 2.0 * shape.z * distance / depth + 1.0;
    vec2 scale = vec2(size, -size) / shape.z;
    offsetOfPlace = vec3(dot(cameraRight.xyz, right) * scale.x, dot(cameraRight.xyz, up) * scale.x,
                         dot(cameraUp.xyz, up) * scale.y);
    gl_PointSize = size;
    gl_Position = clipFromWorld * vec4(sphere.xyz, 1.0);
#ifdef DOTS
    gl_Position = clipFromWorld * vec4(sphere.xyz - radius * axis, 1.0);
    vec3 away = tint.rgb * shadow.rgb + 0.02 * horizon.rgb;
    dark = vec4(mix(away, horizon.rgb, lightInQuad.w), tint.a);
    bright = vec4((1.0 - lightInQuad.w) * tint.rgb * (1.0 - shadow.rgb),
                  mix(1.0, horizon.g, lightInQuad.w));
    slope = 0.5 * lightInQuad.xyz;
#endif
}

#endif

#else

// How much of a pixel a circle covers, by the square of how far its centre is from the pixel, in radii.
float coverageOf(float squared, float pixels) {
    return min((1.0 - sqrt(squared)) * pixels + 0.5, 1.0);
}

#ifdef DOTS

flat in vec4 shape;
flat in vec3 offsetOfPlace;
flat in vec4 dark;
flat in vec4 bright;
flat in vec3 slope;

out vec4 colour;

void main() {
    vec2 place = gl_PointCoord - 0.5;
    vec2 offset = place.x * offsetOfPlace.xy + vec2(0.0, place.y * offsetOfPlace.z);
    float squared = dot(offset, offset);
    float coverage = coverageOf(squared, shape.z);
    if (coverage <= 0.0) {
        discard;
    }
    float towardsLight = dot(slope, vec3(offset, sqrt(max(1.0 - squared, 0.0))));
    float brightness = 0.5 + towardsLight;
    vec3 lit = dark.rgb + min(1.1 * brightness * brightness, 1.0) * bright.rgb;
    float gleam = max(2.0 * towardsLight, 0.0);
    gleam *= gleam;
    colour = vec4(mix(lit, bright.aaa, 0.2 * gleam * gleam), dark.a * coverage);
}

#else

flat in vec4 tint;
flat in vec4 lightInQuad;
flat in vec4 shape;

out vec4 colour;

void paintSphere(vec2 offset) {
    float squared = dot(offset, offset);
    float coverage = coverageOf(squared, shape.z);
    if (coverage <= 0.0) {
        discard;
    }
    float h = sqrt(max(1.0 - squared, 0.0));
    float s = shape.x;
    vec3 normal = vec3(shape.y * offset, s + h) / (1.0 + s * h);
    vec3 lit = shadeRound(tint.rgb, dot(normal, lightInQuad.xyz));
    float rim = (1.0 - h) * (1.0 - h);
    lit += 0.12 * rim * horizon.rgb;
    colour = vec4(mix(lit, horizon.rgb, lightInQuad.w), tint.a * coverage);
    gl_FragDepth = gl_FragCoord.z + shape.w * h * gl_FragCoord.w;
}

#ifdef QUADS

in vec2 offset;

void main() {
    paintSphere(offset);
}

#else

flat in vec3 offsetOfPlace;

void main() {
    vec2 place = gl_PointCoord - 0.5;
    paintSphere(place.x * offsetOfPlace.xy + vec2(0.0, place.y * offsetOfPlace.z));
}

#endif
#endif
#endif
