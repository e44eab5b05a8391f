// SPDX-License-Identifier: Zlib

#ifdef VERTEX

// Colour, light and haze change slowly over the ground, so vertices are shaded, not pixels.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;

uniform vec3 meadow;
uniform vec3 summit;
uniform vec3 slope;
uniform vec2 heights;    // the lowest, and one over the difference to the highest
uniform vec3 lineCells;  // x and z of a corner, and one over the size
uniform vec3 heatCells;  // the same; in squares of the whole map

out vec4 ground;         // colour, and the share of haze
out vec4 cells;          // of the lines, and of the heat map

void main() {
    float level = clamp((position.y - heights.x) * heights.y, 0.0, 1.0);
    float steepness = smoothstep(0.04, 0.3, 1.0 - normal.y);
    vec3 base = mix(mix(meadow, summit, level), slope, steepness);
    // Hills are drawn twice as steep as they are, or one would not see them.
    float towardsLight = light.y + 2.0 * (dot(normal, light.xyz) - light.y);
    ground = vec4(shade(base, min(towardsLight, 1.0)), haze(position - eye.xyz));
    cells = vec4((position.xz - lineCells.xy) * lineCells.z, position.xz - heatCells.xy);
    gl_Position = clipFromWorld * vec4(position, 1.0);
}

#else

in vec4 ground;
in vec4 cells;

uniform vec4 lineColour;
uniform vec2 heatScale;
uniform sampler2D loads;
uniform sampler2D ramp;

out vec4 colour;

// Lines a pixel wide, which fade where cells become too small to be told apart.
float gridLine(vec2 place) {
    vec2 width = fwidth(place);
    vec2 distance = abs(fract(place - 0.5) - 0.5) / width;
    float line = 1.0 - min(min(distance.x, distance.y), 1.0);
    return line * clamp(1.6 - 5.0 * max(width.x, width.y), 0.0, 1.0);
}

void main() {
    vec3 seen = ground.rgb;
    if (hasHeat) {
        vec2 place = cells.zw * heatScale;
        float load = texture(loads, place).r;
        vec3 hot = texture(ramp, vec2(load, 0.5)).rgb * (0.5 + 0.5 * dot(seen, vec3(0.5)));
        bool isInside = all(greaterThanEqual(place, vec2(0.0))) && all(lessThan(place, vec2(1.0)));
        seen = mix(seen, hot, isInside && load > 0.0 ? 0.85 : 0.0);
    }
    if (hasLines) {
        seen = mix(seen, lineColour.rgb, lineColour.a * gridLine(cells.xy));
    }
    colour = vec4(mix(seen, horizon.rgb, ground.a), 1.0);
}

#endif
