// SPDX-License-Identifier: Zlib
//
// Culling for a renderer of one's own: a list of objects, a view-projection matrix, and what is to be
// drawn. You should see a map of 3,600 trees from above, 60 by 60, with the camera at its lower edge:
// `#` is drawn, `.` is not. What is drawn opens from the camera like a fan, and ends at the far plane.

#include <integration/camera/frustum.hpp>
#include <integration/culling/culler.hpp>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

using namespace hashphase;

namespace {

struct Tree {
    int column = 0;
    int row = 0;
};

// What a renderer has anyway: OpenGL's perspective matrix, after that of the camera's place and turn.
Eigen::Matrix4f viewProjection(const Vector3<float>& eye, float yaw) {
    const float near = 1, far = 80;  // [m]
    Eigen::Matrix4f projection = Eigen::Matrix4f::Zero();
    projection(0, 0) = projection(1, 1) = 1 / std::tan(0.5F);  // 1 rad wide and high
    projection(2, 2) = (near + far) / (near - far);
    projection(2, 3) = 2 * near * far / (near - far);
    projection(3, 2) = -1;
    const Eigen::Affine3f camera(Eigen::Translation3f(eye) *
                                 Eigen::AngleAxisf(yaw, Vector3<float>::UnitY()));
    return projection * camera.inverse().matrix();
}

}  // namespace

int main() {
    Grid<float> grid;
    std::vector<Tree> trees(3600);  // by ProxyId::index
    for (int i = 0; i < 3600; ++i) {
        const Tree tree{i % 60, i / 60};
        const Vector3<float> middle(2 * static_cast<float>(tree.column), 3,
                                    2 * static_cast<float>(tree.row));
        const ProxyId id = grid.add(boxAround(middle, {0.5F, 3, 0.5F}), Mobility::resting);
        trees[id.index] = tree;
    }

    // A frame of the renderer. glm::mat4 and float[16] are Eigen::Map<const Eigen::Matrix4f>(pointer).
    Culler<float> culler;
    const QueryCost cost = culler.look(
        grid, frustumRegion<float>(viewProjection({60, 2, 119}, 0.3F), DepthRange::minusOneToOne));
    std::string picture(60 * 61, '.');
    culler.forEach([&](std::uint32_t index) {  // here draw(trees[index])
        const Tree& tree = trees[index];
        picture[static_cast<std::size_t>(61 * tree.row + tree.column)] = '#';
    });

    for (std::size_t end = 60; end < picture.size(); end += 61) {
        picture[end] = '\n';
    }
    std::printf("%s", picture.c_str());
    std::printf("drawn: %zu of %zu trees, %zu of them drawn needlessly; boxes tested: %d\n",
                culler.count(), grid.size(), culler.overdraw(grid).unseen,
                static_cast<int>(cost.boxesTested));
}
