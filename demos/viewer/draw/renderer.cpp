// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/renderer.hpp>

#include <demos/viewer/draw/box_layer.hpp>
#include <demos/viewer/draw/capsule_layer.hpp>
#include <demos/viewer/draw/contact_layer.hpp>
#include <demos/viewer/draw/draw_error.hpp>
#include <demos/viewer/draw/frame_target.hpp>
#include <demos/viewer/draw/ground_layer.hpp>
#include <demos/viewer/draw/line_layer.hpp>
#include <demos/viewer/draw/quad_indices.hpp>
#include <demos/viewer/draw/rectangle_layer.hpp>
#include <demos/viewer/draw/sky_layer.hpp>
#include <demos/viewer/draw/sphere_layer.hpp>

#include <algorithm>
#include <string>

namespace hashphase::demos {

namespace {

constexpr float kReachOfGround = 1.4F;   // haze is complete so many diagonals of the ground away
constexpr float kReachOfNothing = 1000;  // and so far away where there is none [m]

}  // namespace

struct Renderer::Layers {
    Layers(int width, int height) : target(width, height) {}

    void drawFrame(const Picture& picture, unsigned framebuffer);
    void uploadFrame(const Picture& picture, const View& view) const;

    FrameTarget target;
    GlBuffer frame;
    QuadIndices quads;
    SkyLayer sky;
    GroundLayer ground;
    ContactLayer contacts;
    BoxLayer boxes;
    CapsuleLayer capsules;
    SphereLayer spheres;
    LineLayer lines;
    RectangleLayer rectangle;
};

void Renderer::Layers::uploadFrame(const Picture& picture, const View& view) const {
    const float reach = ground.mesh().vertices.empty()
                            ? kReachOfNothing
                            : kReachOfGround * ground.mesh().bounds.diagonal().norm();
    const FrameUniforms uniforms =
        frameUniforms(view, themeColours(picture.theme), picture.leastRadius, reach);
    glBindBufferBase(GL_UNIFORM_BUFFER, kFrameBinding, frame.name());
    glBufferData(GL_UNIFORM_BUFFER, sizeof(uniforms), &uniforms, GL_STREAM_DRAW);
}

void Renderer::Layers::drawFrame(const Picture& picture, unsigned framebuffer) {
    const View view(picture.camera,
                    {static_cast<float>(target.width()), static_cast<float>(target.height())});
    if (ground.update(picture.ground)) {
        contacts.setGround(ground.mesh());
    }
    uploadFrame(picture, view);

    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, target.width(), target.height());
    const int covered = std::clamp(picture.coveredLeft, 0, target.width());
    glEnable(GL_SCISSOR_TEST);
    glScissor(covered, 0, target.width() - covered, target.height());
    glDisable(GL_CULL_FACE);
    glCullFace(GL_BACK);
    glFrontFace(GL_CCW);
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    // The picture stays opaque, whatever is blended into it.
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glClear(GL_DEPTH_BUFFER_BIT);

    ground.draw(picture, view);
    sky.draw();
    contacts.draw(picture.spheres, view, picture.contactFrom, quads);
    boxes.draw(picture.boxes, view, quads);
    capsules.draw(picture.capsules, view);
    spheres.draw(picture.spheres, view, picture.leastRadius, quads);
    lines.draw(picture.lines, quads);
    if (picture.rectangle) {
        rectangle.draw(*picture.rectangle, picture.theme);
    }
    glDisable(GL_SCISSOR_TEST);
}

Renderer::Renderer(int width, int height) : layers_(std::make_unique<Layers>(width, height)) {}
Renderer::~Renderer() = default;

void Renderer::resize(int width, int height) {
    if (width != layers_->target.width() || height != layers_->target.height()) {
        layers_->target = FrameTarget(width, height);
    }
}

int Renderer::width() const {
    return layers_->target.width();
}

int Renderer::height() const {
    return layers_->target.height();
}

unsigned Renderer::framebuffer() const {
    return layers_->target.name();
}

Image Renderer::read() const {
    return layers_->target.read();
}

void Renderer::draw(const Picture& picture, unsigned framebuffer) {
    layers_->drawFrame(picture, framebuffer);
    if (const GLenum fault = glGetError(); fault != GL_NO_ERROR) {
        throw DrawError("OpenGL refused a part of the picture (error " + std::to_string(fault) +
                        ").");
    }
}

}  // namespace hashphase::demos
