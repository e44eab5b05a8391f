// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/sky_layer.hpp>

namespace hashphase::demos {

namespace {

// One triangle that covers the screen.
constexpr const char* kVertexShader = R"glsl(
out vec3 direction;

void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    direction = cameraForward.xyz + corner.x * cameraRight.w * cameraRight.xyz +
                corner.y * cameraUp.w * cameraUp.xyz;
    gl_Position = vec4(corner, 1.0, 1.0);
}
)glsl";

constexpr const char* kFragmentShader = R"glsl(
in vec3 direction;
out vec4 colour;

void main() {
    float height = direction.y * inversesqrt(dot(direction, direction));
    float above = max(height, 0.0);
    float below = max(-height, 0.0);
    vec3 sky = mix(horizon.rgb, skyAbove.rgb, above * (2.0 - above));
    colour = vec4(mix(sky, skyBelow.rgb, min(4.0 * below, 1.0)), 1.0);
}
)glsl";

}  // namespace

SkyLayer::SkyLayer() : program_("the sky", kVertexShader, kFragmentShader) {}

void SkyLayer::draw() const {
    program_.use();
    glBindVertexArray(vertices_.name());
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_FALSE);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
}

}  // namespace hashphase::demos
