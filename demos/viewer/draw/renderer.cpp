// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/renderer.hpp>

#include <demos/viewer/draw/palette.hpp>

#include <algorithm>
#include <string>
#include <utility>

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

// --- What is drawn into --------------------------------------------------------------------------

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

// --- A frame -------------------------------------------------------------------------------------

// Whatever state there was.
void Renderer::prepare(const Picture& picture, const View& view, unsigned framebuffer) {
    const float reach = ground_.ground().vertices().empty()
                            ? kReachOfNothing
                            : kReachOfGround * ground_.ground().bounds().diagonal().norm();
    const FrameUniforms uniforms = frameUniforms(view, picture, reach);
    glBindBufferBase(GL_UNIFORM_BUFFER, ShaderProgram::kFrameBinding, frame_.name());
    glBufferData(GL_UNIFORM_BUFFER, sizeof(uniforms), &uniforms, GL_STREAM_DRAW);

    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, target_.width, target_.height);
    const int covered = std::clamp(picture.coveredLeft, 0, target_.width);
    glEnable(GL_SCISSOR_TEST);
    glScissor(covered, 0, target_.width - covered, target_.height);
    glFrontFace(GL_CCW);
    glEnable(GL_DEPTH_TEST);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    // The picture stays opaque, whatever is blended into it.
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    setState({});
    glClear(GL_DEPTH_BUFFER_BIT);
}

void Renderer::draw(const Picture& picture, unsigned framebuffer) {
    const View view(picture.camera,
                    {static_cast<float>(target_.width), static_cast<float>(target_.height)});
    ground_.update(picture.ground);
    prepare(picture, view, framebuffer);
    ground_.draw(picture, view);
    drawSky(sky_);
    bodies_.draw(picture, view, ground_.ground());
    if (picture.rectangle) {
        drawRectangle(*picture.rectangle, picture.theme, rectangle_);
    }
    glDisable(GL_SCISSOR_TEST);
    setState({});
    if (const GLenum fault = glGetError(); fault != GL_NO_ERROR) {
        throw DrawError("OpenGL refused a part of the picture (error " + std::to_string(fault) +
                        ").");
    }
}

void Renderer::resize(int width, int height) {
    if (width != target_.width || height != target_.height) {
        target_ = FrameTarget(width, height);
    }
}

Image Renderer::read() const {
    const auto [width, height] = std::pair(target_.width, target_.height);
    Image image{width, height, {}};
    const std::size_t rowSize = std::size_t{4} * width;
    image.pixels.resize(rowSize * height);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, image.pixels.data());
    // OpenGL's first row is the lowest one.
    for (int row = 0; row < height / 2; ++row) {
        std::uint8_t* const top = image.pixels.data() + rowSize * row;
        std::swap_ranges(top, top + rowSize, image.pixels.data() + rowSize * (height - 1 - row));
    }
    return image;
}

}  // namespace hashphase::demos
