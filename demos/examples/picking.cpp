// SPDX-License-Identifier: Zlib
//
// Picking with a mouse, in a window of 800 x 600 pixels, over 8 x 6 pieces on a board that is seen
// aslant. You should see which piece each click hits and where, which ones stand behind one another
// below one click, and which ones a rectangle selects that is dragged.

#include <integration/picking/drag_selection.hpp>
#include <integration/picking/pick.hpp>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

using namespace hashphase;

namespace {

// What a game has anyway: Direct3D's and Vulkan's perspective matrix, of a camera that looks down.
Eigen::Matrix4f viewProjection(const Vector3<float>& eye, float down, float aspect) {
    const float near = 0.1F, far = 100, scale = 1 / std::tan(0.4F);
    Eigen::Matrix4f projection = Eigen::Matrix4f::Zero();
    projection(0, 0) = scale / aspect;
    projection(1, 1) = scale;
    projection(2, 2) = far / (near - far);
    projection(2, 3) = near * far / (near - far);
    projection(3, 2) = -1;
    const Eigen::Affine3f camera(Eigen::Translation3f(eye) *
                                 Eigen::AngleAxisf(-down, Vector3<float>::UnitX()));
    return projection * camera.inverse().matrix();
}

}  // namespace

int main() {
    Grid<float> grid;
    std::vector<std::string> names(48);  // by ProxyId::index
    for (int i = 0; i < 48; ++i) {
        const Vector3<float> middle(static_cast<float>(i % 8) - 3.5F, 0.4F,
                                    -static_cast<float>(i / 8));
        const ProxyId id = grid.add(boxAround(middle, {0.3F, 0.4F, 0.3F}));
        names[id.index] = {static_cast<char>('a' + i % 8), static_cast<char>('1' + i / 8)};
    }
    const Camera<float> camera(viewProjection({0, 2, 4}, 0.3F, 800.0F / 600), DepthRange::zeroToOne,
                               Viewport{0, 0, 800, 600});

    // Clicks: the nearest piece below the pointer.
    for (const Pixel& pixel : {Pixel(450, 330), Pixel(400, 330), Pixel(660, 420)}) {
        const Picked<float> picked = pickNearest(grid, camera.rayThrough(pixel));
        if (picked.id.isNull()) {
            std::printf("(%.0f, %.0f): nothing\n", pixel.x(), pixel.y());
        } else {
            std::printf("(%.0f, %.0f): %s, %.2f m above the board\n", pixel.x(), pixel.y(),
                        names[picked.id.index].c_str(), static_cast<double>(picked.point.y()));
        }
    }

    // All that is below the pointer, from near to far.
    std::vector<Picked<float>> below;
    pickAll(grid, camera.rayThrough({450, 330}), below);
    std::printf("behind one another:");
    for (const Picked<float>& picked : below) {
        std::printf(" %s", names[picked.id.index].c_str());
    }

    // A rectangle that is dragged: all that lies wholly within.
    std::vector<ProxyId> selected;
    select(grid, camera, {640, 380}, {330, 150}, selected, Containment::inside);
    std::printf("\nselected:");
    for (const ProxyId id : selected) {
        std::printf(" %s", names[id.index].c_str());
    }
    std::printf("\n");
}
