// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/rectangle_layer.hpp>

#include <demos/viewer/draw/palette.hpp>

namespace hashphase::demos {

namespace {

constexpr const char* kRectangleVertexShader = R"glsl(
uniform vec4 corners;  // left, top, right, bottom [pixels]

out vec2 place;

void main() {
    place = vec2((gl_VertexID & 1) == 0 ? corners.x : corners.z,
                 (gl_VertexID & 2) == 0 ? corners.y : corners.w);
    vec2 share = place / screen.xy;
    gl_Position = vec4(2.0 * share.x - 1.0, 1.0 - 2.0 * share.y, 0.0, 1.0);
}
)glsl";

constexpr const char* kRectangleFragmentShader = R"glsl(
in vec2 place;

uniform vec4 corners;
uniform vec3 tint;

out vec4 colour;

void main() {
    vec2 inside = min(place - corners.xy, corners.zw - place);
    bool isBorder = min(inside.x, inside.y) < 2.0;
    colour = vec4(tint, isBorder ? 0.95 : 0.16);
}
)glsl";

}  // namespace

RectangleLayer::RectangleLayer()
    : program_("the rectangle", kRectangleVertexShader, kRectangleFragmentShader) {}

void RectangleLayer::draw(const DrawnRectangle& rectangle, Theme theme) const {
    const Eigen::Vector2f first = rectangle.from.cwiseMin(rectangle.to);
    const Eigen::Vector2f last = rectangle.from.cwiseMax(rectangle.to);
    const Colour tint = palette(theme).selected;
    program_.use();
    glUniform4f(program_.uniform("corners"), first.x(), first.y(), last.x(), last.y());
    glUniform3f(program_.uniform("tint"), static_cast<float>(tint.red) / 255,
                static_cast<float>(tint.green) / 255, static_cast<float>(tint.blue) / 255);
    glBindVertexArray(vertices_.name());
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
}

}  // namespace hashphase::demos
