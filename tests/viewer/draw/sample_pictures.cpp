// SPDX-License-Identifier: Zlib
#include <tests/viewer/draw/sample_pictures.hpp>

#include <demos/viewer/draw/headless_context.hpp>
#include <demos/viewer/draw/palette.hpp>
#include <tests/support/camera_matrices.hpp>

#include <algorithm>
#include <cmath>
#include <random>

namespace hashphase::demos {
namespace {

constexpr float kHalfExtent = 80;  // of the hills [m]
constexpr int kCellCount = 20;
const float kTangent = std::tan(0.5F);

std::vector<Vector3<float>> cornersOfHills() {
    constexpr int kSquares = 40;
    const auto corner = [](int column, int row) {
        const float x = kHalfExtent * (2 * static_cast<float>(column) / kSquares - 1);
        const float z = kHalfExtent * (2 * static_cast<float>(row) / kSquares - 1);
        return Vector3<float>(x, SampleWorld::height(x, z), z);
    };
    std::vector<Vector3<float>> corners;
    for (int row = 0; row < kSquares; ++row) {
        for (int column = 0; column < kSquares; ++column) {
            corners.insert(corners.end(), {corner(column, row), corner(column, row + 1),
                                           corner(column + 1, row), corner(column + 1, row),
                                           corner(column, row + 1), corner(column + 1, row + 1)});
        }
    }
    return corners;
}

}  // namespace

DrawnCamera sampleCamera(const Vector3<float>& eye, const Vector3<float>& target) {
    const test::CameraLens lens{
        .aspect = double{kSampleWidth} / kSampleHeight, .nearPlane = 0.5, .farPlane = 400};
    return {test::cameraMatrix<float>(lens, eye.cast<double>(), target.cast<double>()), eye};
}

Eigen::Vector2f onScreen(const DrawnCamera& camera, const Vector3<float>& point) {
    const Eigen::Vector4f clip = camera.viewProjection * point.homogeneous();
    return {(0.5F + 0.5F * clip.x() / clip.w()) * kSampleWidth,
            (0.5F - 0.5F * clip.y() / clip.w()) * kSampleHeight};
}

float radiusOnScreen(float radius, float distance) {
    const float tangent = radius / std::sqrt(distance * distance - radius * radius);
    return tangent / kTangent * kSampleHeight / 2;
}

float SampleWorld::height(float x, float z) {
    return 4 * std::sin(x * 0.06F) * std::cos(z * 0.05F) + 2 * std::sin(z * 0.11F + 1);
}

SampleWorld::SampleWorld() : corners(cornersOfHills()), loads(kCellCount * kCellCount) {
    const auto& colours = qualitativeColours(Theme::light);
    std::mt19937 random(11);
    const auto share = [&random] { return static_cast<float>(random() % 4096) / 4096; };
    for (std::uint32_t i = 0; i < 500; ++i) {
        const float x = (2 * share() - 1) * kHalfExtent, z = (2 * share() - 1) * kHalfExtent;
        const float radius = 0.5F + share();
        const float lift = i % 3 == 0 ? share() : 0;
        spheres.push_back({{x, height(x, z) + (1 + lift) * radius, z},
                           radius,
                           colours[i % 5 == 0 ? i / 5 % 7 : 0]});
        const auto cell = [](float at) {
            return std::clamp(static_cast<int>((at + kHalfExtent) / 8), 0, kCellCount - 1);
        };
        std::uint8_t& load = loads[cell(z) * kCellCount + cell(x)];
        load = static_cast<std::uint8_t>(std::min(255, load + 50));
    }
    for (std::uint32_t i = 0; i < 5; ++i) {
        const float turn = 0.4F * static_cast<float>(i);
        const float x = -12 + 6 * static_cast<float>(i);
        const Eigen::Quaternionf turned(
            Eigen::AngleAxisf(turn, Vector3<float>(0.3F, 1, 0.2F).normalized()));
        boxes.push_back({{x, height(x, 0) + 1.5F, 0},
                         {1.5F, 1 + 0.2F * turn, 1.2F},
                         turned.coeffs(),
                         colours[i]});
        const Vector3<float> from(x, height(x, 8) + 1, 8);
        capsules.push_back({from, from + Vector3<float>(2, turn, turn), 0.8F, colours[i + 2]});
        const Vector3<float> foot(x, height(x, -8), -8);
        lines.push_back({foot, foot + Vector3<float>(0, 5, 0), palette(Theme::light).line, false});
        lines.push_back({from, foot, palette(Theme::light).alert, true});
    }
}

Picture SampleWorld::picture() const {
    Picture picture;
    picture.camera = sampleCamera({0, 12, 40}, {0, 2, 0});
    picture.spheres = spheres;
    picture.ground = {corners, 1};
    return picture;
}

GroundCells SampleWorld::cells() const {
    return {Eigen::Vector2f::Constant(-kHalfExtent), 2 * kHalfExtent / kCellCount};
}

HeatMap SampleWorld::heatMap() const {
    return {cells(), kCellCount, kCellCount, loads};
}

Renderer& sampleRenderer() {
    static HeadlessContext context;
    static Renderer renderer(kSampleWidth, kSampleHeight);
    return renderer;
}

Image drawn(const Picture& picture) {
    sampleRenderer().draw(picture);
    return sampleRenderer().read();
}

}  // namespace hashphase::demos
