// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/ground_layer.hpp>

#include <demos/viewer/draw/draw_error.hpp>
#include <demos/viewer/draw/palette.hpp>

#include <algorithm>
#include <cstddef>
#include <string>

namespace hashphase::demos {

namespace {

// Colour, light and haze change slowly over the ground, so vertices are shaded, not pixels.
constexpr const char* kGroundVertexShader = R"glsl(
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
)glsl";

constexpr const char* kGroundFragmentShader = R"glsl(
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
)glsl";

constexpr int kRampLength = 256;
constexpr GLint kLoadsUnit = 0;
constexpr GLint kRampUnit = 1;

void setUniform(const ShaderProgram& program, const char* name, const Vector3<float>& value) {
    glUniform3fv(program.uniform(name), 1, value.data());
}

void bindTexture(GLint unit, const GlTexture& texture) {
    glActiveTexture(static_cast<GLenum>(GL_TEXTURE0 + unit));
    glBindTexture(GL_TEXTURE_2D, texture.name());
}

void setSampling(GLint filter) {
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

}  // namespace

GroundLayer::Variant::Variant(bool hasLines, bool hasHeat)
    : program("the ground", kGroundVertexShader,
              std::string("const bool hasLines = ") + (hasLines ? "true" : "false") +
                  ";\nconst bool hasHeat = " + (hasHeat ? "true" : "false") + ";\n" +
                  kGroundFragmentShader) {}

GroundLayer::GroundLayer()
    : variants_{Variant(false, false), Variant(true, false), Variant(false, true),
                Variant(true, true)} {
    glBindVertexArray(vertexArray_.name());
    glBindBuffer(GL_ARRAY_BUFFER, vertexBuffer_.name());
    indexBuffer_.bind(GL_ELEMENT_ARRAY_BUFFER);
    describeVertexField({0, 3, GL_FLOAT, false, offsetof(GroundVertex, position)},
                        sizeof(GroundVertex));
    describeVertexField({1, 3, GL_FLOAT, false, offsetof(GroundVertex, normal)},
                        sizeof(GroundVertex));

    std::array<Colour, kRampLength> ramp;
    for (int i = 0; i < kRampLength; ++i) {
        ramp[i] = sequentialColour(static_cast<float>(i) / (kRampLength - 1));
    }
    bindTexture(kRampUnit, ramp_);
    setSampling(GL_LINEAR);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kRampLength, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 ramp.data());
    bindTexture(kLoadsUnit, loads_);
    setSampling(GL_NEAREST);
}

bool GroundLayer::update(const DrawnGround& ground) {
    if (version_ == ground.version && mesh_.indices.size() == ground.corners.size()) {
        return false;
    }
    version_ = ground.version;
    mesh_ = makeGroundMesh(ground.corners);
    glBindVertexArray(vertexArray_.name());
    glBindBuffer(GL_ARRAY_BUFFER, vertexBuffer_.name());
    glBufferData(GL_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(mesh_.vertices.size() * sizeof(GroundVertex)),
                 mesh_.vertices.data(), GL_STATIC_DRAW);
    levels_ = GroundLevels(mesh_);
    indices_ = mesh_.indices;
    indices_.reserve(2 * mesh_.indices.size());
    return true;
}

void GroundLayer::draw(const Picture& picture, const View& view) {
    if (levels_.hasLevels()) {
        levels_.choose(view, indices_);
    }
    if (indices_.empty()) {
        return;
    }
    indexBuffer_.fill<std::uint32_t>(indices_.size(), [this](std::span<std::uint32_t> memory) {
        std::ranges::copy(indices_, memory.begin());
    });
    const bool hasHeat = picture.heatMap && !picture.heatMap->loads.empty();
    const std::size_t variant = (picture.gridLines ? 1U : 0U) + (hasHeat ? 2U : 0U);
    const ShaderProgram& program = variants_[variant].program;
    program.use();
    setUniforms(program, picture);
    if (hasHeat) {
        uploadHeat(*picture.heatMap);
    }
    glBindVertexArray(vertexArray_.name());
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(indices_.size()), GL_UNSIGNED_INT, nullptr);
}

void GroundLayer::setUniforms(const ShaderProgram& program, const Picture& picture) {
    const ThemeColours& colours = themeColours(picture.theme);
    setUniform(program, "meadow", colours.meadow);
    setUniform(program, "summit", colours.summit);
    setUniform(program, "slope", colours.slope);
    const float lowest = mesh_.bounds.min().y();
    const float difference = std::max(mesh_.bounds.max().y() - lowest, 1.0F);
    glUniform2f(program.uniform("heights"), lowest, 1 / difference);
    if (picture.gridLines) {
        const GroundCells& lines = *picture.gridLines;
        const Colour line = palette(picture.theme).line;
        setUniform(program, "lineCells", {lines.corner.x(), lines.corner.y(), 1 / lines.cellSize});
        glUniform4f(program.uniform("lineColour"), static_cast<float>(line.red) / 255,
                    static_cast<float>(line.green) / 255, static_cast<float>(line.blue) / 255,
                    0.3F);
    }
    if (picture.heatMap) {
        const HeatMap& heat = *picture.heatMap;
        setUniform(program, "heatCells", {heat.cells.corner.x(), heat.cells.corner.y(), 0});
        glUniform2f(program.uniform("heatScale"),
                    1 / (heat.cells.cellSize * static_cast<float>(heat.columns)),
                    1 / (heat.cells.cellSize * static_cast<float>(heat.rows)));
        glUniform1i(program.uniform("loads"), kLoadsUnit);
        glUniform1i(program.uniform("ramp"), kRampUnit);
    }
}

void GroundLayer::uploadHeat(const HeatMap& heatMap) {
    if (heatMap.loads.size() != std::size_t{heatMap.columns} * heatMap.rows) {
        throw DrawError("A heat map of " + std::to_string(heatMap.columns) + " x " +
                        std::to_string(heatMap.rows) + " cells has " +
                        std::to_string(heatMap.loads.size()) + " loads.");
    }
    bindTexture(kRampUnit, ramp_);
    bindTexture(kLoadsUnit, loads_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    const auto width = static_cast<GLsizei>(heatMap.columns);
    const auto height = static_cast<GLsizei>(heatMap.rows);
    if (width != loadsWidth_ || height != loadsHeight_) {
        glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, width, height, 0, GL_RED, GL_UNSIGNED_BYTE, nullptr);
        loadsWidth_ = width;
        loadsHeight_ = height;
    }
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RED, GL_UNSIGNED_BYTE,
                    heatMap.loads.data());
}

}  // namespace hashphase::demos
