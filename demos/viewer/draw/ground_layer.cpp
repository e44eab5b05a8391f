// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/ground_layer.hpp>

#include <demos/viewer/draw/palette.hpp>

#include <algorithm>
#include <string>

namespace hashphase::demos {

namespace {

constexpr int kRampLength = 256;
constexpr GLint kLoadsUnit = 0;
constexpr GLint kRampUnit = 1;

std::string definitions(bool hasLines, bool hasHeat) {
    return std::string("const bool hasLines = ") + (hasLines ? "true" : "false") +
           ";\nconst bool hasHeat = " + (hasHeat ? "true" : "false") + ";\n";
}

void setUniform(const ShaderProgram& program, const char* name, const Vector3<float>& value) {
    glUniform3fv(program.uniform(name), 1, value.data());
}

void bindTexture(GLint unit, const GlTexture& texture, GLint filter) {
    glActiveTexture(static_cast<GLenum>(GL_TEXTURE0 + unit));
    glBindTexture(GL_TEXTURE_2D, texture.name());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

}  // namespace

GroundLayer::GroundLayer()
    : programs_{ShaderProgram("ground", definitions(false, false)),
                ShaderProgram("ground", definitions(true, false)),
                ShaderProgram("ground", definitions(false, true)),
                ShaderProgram("ground", definitions(true, true))} {
    glBindVertexArray(vertexArray_.name());
    glBindBuffer(GL_ARRAY_BUFFER, vertexBuffer_.name());
    indexBuffer_.bind();
    describeVertex({3, 3}, sizeof(Ground::Point));

    std::array<Colour, kRampLength> ramp;
    for (int i = 0; i < kRampLength; ++i) {
        ramp[i] = sequentialColour(static_cast<float>(i) / (kRampLength - 1));
    }
    bindTexture(kRampUnit, ramp_, GL_LINEAR);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kRampLength, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 ramp.data());
}

void GroundLayer::update(const DrawnGround& ground) {
    if (version_ == ground.version && cornerCount_ == ground.corners.size()) {
        return;
    }
    version_ = ground.version;
    cornerCount_ = ground.corners.size();
    ground_ = Ground(ground.corners);
    indices_.reserve(2 * cornerCount_);
    glBindBuffer(GL_ARRAY_BUFFER, vertexBuffer_.name());
    glBufferData(GL_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(ground_.vertices().size() * sizeof(Ground::Point)),
                 ground_.vertices().data(), GL_STATIC_DRAW);
}

void GroundLayer::draw(const Picture& picture, const View& view) {
    ground_.choose(view, indices_);
    if (indices_.empty()) {
        return;
    }
    glBindVertexArray(vertexArray_.name());
    indexBuffer_.fill<std::uint32_t>(indices_.size(), [this](std::span<std::uint32_t> memory) {
        std::ranges::copy(indices_, memory.begin());
    });
    const bool hasHeat = picture.heatMap && !picture.heatMap->loads.empty();
    const ShaderProgram& program = programs_[(picture.gridLines ? 1U : 0U) + (hasHeat ? 2U : 0U)];
    program.use();
    setUniforms(program, picture);
    if (hasHeat) {
        uploadHeat(*picture.heatMap);
    }
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(indices_.size()), GL_UNSIGNED_INT, nullptr);
}

void GroundLayer::setUniforms(const ShaderProgram& program, const Picture& picture) {
    const ThemeColours& colours = themeColours(picture.theme);
    setUniform(program, "meadow", colours.meadow);
    setUniform(program, "summit", colours.summit);
    setUniform(program, "slope", colours.slope);
    const float lowest = ground_.bounds().min().y();
    const float difference = std::max(ground_.bounds().max().y() - lowest, 1.0F);
    glUniform2f(program.uniform("heights"), lowest, 1 / difference);
    if (picture.gridLines) {
        const GroundCells& lines = *picture.gridLines;
        const Vector3<float> line = asVector(palette(picture.theme).line);
        setUniform(program, "lineCells", {lines.corner.x(), lines.corner.y(), 1 / lines.cellSize});
        glUniform4f(program.uniform("lineColour"), line.x(), line.y(), line.z(), 0.3F);
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
    bindTexture(kRampUnit, ramp_, GL_LINEAR);
    bindTexture(kLoadsUnit, loads_, GL_NEAREST);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, static_cast<GLsizei>(heatMap.columns),
                 static_cast<GLsizei>(heatMap.rows), 0, GL_RED, GL_UNSIGNED_BYTE,
                 heatMap.loads.data());
}

}  // namespace hashphase::demos
