// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/renderer.hpp>

#include <demos/viewer/draw/body_layers.hpp>
#include <demos/viewer/draw/ground_layer.hpp>
#include <demos/viewer/draw/palette.hpp>

#include <algorithm>
#include <string>

namespace hashphase::demos {

namespace {

constexpr float kReachOfGround = 1.4F;    // haze is complete so many diagonals of the ground away
constexpr float kReachOfNothing = 1000;   // and so far away where there is none [m]
constexpr float kHazeOfFarPlane = 0.98F;  // haze is complete just before the world is cut off

// --- The block `Frame` of all shaders ------------------------------------------------------------

/// In the layout of std140.
struct FrameUniforms {
    Eigen::Matrix4f clipFromWorld;
    Eigen::Vector4f eye;       // and the depth of the eye
    Eigen::Vector4f screen;    // width, height, focal length, least radius [pixels]
    Eigen::Vector4f up;        // of the camera, and the tangent vertically
    Eigen::Vector4f right;     // and the tangent horizontally
    Eigen::Vector4f forward;   // and one over the distance of full haze
    Eigen::Vector4f light;     // towards it, and the share of haze at most
    Eigen::Vector4f skyAbove;  // colours
    Eigen::Vector4f horizon;
    Eigen::Vector4f skyBelow;
    Eigen::Vector4f shadow;
};

Eigen::Vector4f join(const Vector3<float>& vector, float last = 1) {
    return {vector.x(), vector.y(), vector.z(), last};
}

/// `reach` is how far from the eye the world is worth seeing [m]: haze is complete there.
FrameUniforms frameUniforms(const View& view, const Picture& picture, float reach) {
    const ThemeColours& colours = themeColours(picture.theme);
    const float hazeDistance = std::min(kHazeOfFarPlane * view.farPlane, reach);
    const Vector3<float> towardsLight = Vector3<float>(0.38F, 0.86F, 0.34F).normalized();
    return {.clipFromWorld = view.clipFromWorld,
            .eye = join(view.eye, view.eyeDepth),
            .screen = {view.size.x(), view.size.y(), view.focalLength, picture.leastRadius},
            .up = join(view.up, view.tangents.y()),
            .right = join(view.right, view.tangents.x()),
            .forward = join(view.forward, 1 / hazeDistance),
            .light = join(towardsLight, colours.hazeAtMost),
            .skyAbove = join(colours.skyAbove),
            .horizon = join(colours.horizon),
            .skyBelow = join(colours.skyBelow),
            .shadow = join(colours.shadow)};
}

// --- What is drawn into --------------------------------------------------------------------------

/// A framebuffer of colour and depth.
struct FrameTarget {
    FrameTarget(int wide, int high);
    [[nodiscard]] Image read() const;

    int width;
    int height;
    GlFramebuffer framebuffer;
    GlRenderbuffer colour;
    GlRenderbuffer depth;
};

FrameTarget::FrameTarget(int wide, int high) : width(wide), height(high) {
    GLint largest = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
    const std::string size = std::to_string(width) + " x " + std::to_string(height);
    if (std::min(width, height) < 1 || std::max(width, height) > largest) {
        throw DrawError("A picture of " + size + " pixels cannot be drawn: each way, 1 to " +
                        std::to_string(largest) + " are possible.");
    }
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    const auto attach = [&](GLenum place, GLenum format, const GlRenderbuffer& buffer) {
        glBindRenderbuffer(GL_RENDERBUFFER, buffer.name());
        glRenderbufferStorage(GL_RENDERBUFFER, format, width, height);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, place, GL_RENDERBUFFER, buffer.name());
    };
    attach(GL_COLOR_ATTACHMENT0, GL_RGBA8, colour);
    attach(GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT24, depth);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
        throw DrawError("OpenGL offers no framebuffer of " + size +
                        " pixels with colour and depth.");
    }
}

Image FrameTarget::read() const {
    Image image{width, height, {}};
    const std::size_t rowSize = std::size_t{4} * width;
    image.pixels.resize(rowSize * height);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer.name());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, image.pixels.data());
    // OpenGL's first row is the lowest one.
    for (int row = 0; row < height / 2; ++row) {
        std::uint8_t* const top = image.pixels.data() + rowSize * row;
        std::swap_ranges(top, top + rowSize, image.pixels.data() + rowSize * (height - 1 - row));
    }
    return image;
}

// --- The sky, and the rectangle ------------------------------------------------------------------

constexpr GLint kSkyColumns = 8;
constexpr GLint kSkyRows = 40;
/// After what is solid: only what still is as far away as can be is painted.
constexpr DrawState kSkyState{.writesDepth = false, .depthFunction = GL_LEQUAL};
/// Over everything else.
constexpr DrawState kRectangleState{
    .blends = true, .writesDepth = false, .depthFunction = GL_ALWAYS};

void drawSky(Layer& layer) {
    glUniform2i(layer.uniform("squares"), kSkyColumns, kSkyRows);
    layer.drawAgain(kSkyState, 0, 6 * kSkyColumns * kSkyRows);
}

void drawRectangle(const DrawnRectangle& rectangle, Theme theme, Layer& layer) {
    const Eigen::Vector2f first = rectangle.from.cwiseMin(rectangle.to);
    const Eigen::Vector2f last = rectangle.from.cwiseMax(rectangle.to);
    glUniform4f(layer.uniform("corners"), first.x(), first.y(), last.x(), last.y());
    glUniform3fv(layer.uniform("tint"), 1, asVector(palette(theme).selected).data());
    layer.drawAgain(kRectangleState, 0, 6);
}

}  // namespace

// --- A frame -------------------------------------------------------------------------------------

struct Renderer::Layers {
    Layers(int width, int height) : target(width, height) {}
    void drawFrame(const Picture& picture, unsigned framebuffer);
    void prepare(const Picture& picture, const View& view, unsigned framebuffer);

    FrameTarget target;
    GlBuffer frame;
    Layer sky{{.shader = "sky"}};
    GroundLayer ground;
    ContactLayer contacts;
    BoxLayer boxes;
    CapsuleLayer capsules;
    SphereLayer spheres;
    LineLayer lines;
    Layer rectangle{{.shader = "rectangle"}};
};

// Whatever state there was.
void Renderer::Layers::prepare(const Picture& picture, const View& view, unsigned framebuffer) {
    const float reach = ground.ground().vertices().empty()
                            ? kReachOfNothing
                            : kReachOfGround * ground.ground().bounds().diagonal().norm();
    const FrameUniforms uniforms = frameUniforms(view, picture, reach);
    glBindBufferBase(GL_UNIFORM_BUFFER, ShaderProgram::kFrameBinding, frame.name());
    glBufferData(GL_UNIFORM_BUFFER, sizeof(uniforms), &uniforms, GL_STREAM_DRAW);

    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, target.width, target.height);
    const int covered = std::clamp(picture.coveredLeft, 0, target.width);
    glEnable(GL_SCISSOR_TEST);
    glScissor(covered, 0, target.width - covered, target.height);
    glFrontFace(GL_CCW);
    glEnable(GL_DEPTH_TEST);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    // The picture stays opaque, whatever is blended into it.
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    setState({});
    glClear(GL_DEPTH_BUFFER_BIT);
}

void Renderer::Layers::drawFrame(const Picture& picture, unsigned framebuffer) {
    const View view(picture.camera,
                    {static_cast<float>(target.width), static_cast<float>(target.height)});
    ground.update(picture.ground);
    prepare(picture, view, framebuffer);
    ground.draw(picture, view);
    drawSky(sky);
    contacts.draw(picture.spheres, ground.ground(), view, picture.contactFrom);
    boxes.draw(picture.boxes, view);
    capsules.draw(picture.capsules, view);
    spheres.draw(picture.spheres, view, picture.leastRadius);
    lines.draw(picture.lines);
    if (picture.rectangle) {
        drawRectangle(*picture.rectangle, picture.theme, rectangle);
    }
    glDisable(GL_SCISSOR_TEST);
    setState({});
}

Renderer::Renderer(int width, int height) : layers_(std::make_unique<Layers>(width, height)) {}
Renderer::~Renderer() = default;

void Renderer::resize(int width, int height) {
    if (width != layers_->target.width || height != layers_->target.height) {
        layers_->target = FrameTarget(width, height);
    }
}

unsigned Renderer::framebuffer() const {
    return layers_->target.framebuffer.name();
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
