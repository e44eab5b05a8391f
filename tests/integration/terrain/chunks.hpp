// SPDX-License-Identifier: Zlib
#pragma once

#include <tests/integration/terrain/meshes.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace hashphase::test {

/// Chunks side by side around a place, all turned as one, each with its corners relative to its own
/// middle; computed in Scalar, as an engine does it.
template <class Scalar>
class Chunks {
public:
    using Point = Vector3<Scalar>;
    static constexpr int kQuads = 8;  // a side of a chunk, those of which are 1 m

    Chunks(Random& random, const Vector3<double>& place, double tilt)
        : place_(place.cast<Scalar>()) {
        const Vector3<double> axis = Vector3<double>::UnitY() + tilt * random.pointIn(-1, 1);
        turn_ = Eigen::AngleAxis<double>(random.between(-4, 4), axis.normalized())
                    .toRotationMatrix()
                    .template cast<Scalar>();
    }

    /// Where a point of the ground comes to lie, of the chunk around (middleX, middleZ).
    [[nodiscard]] Point placed(double middleX, double middleZ, double x, double y, double z) const {
        const Point origin = turn_ * at<Scalar>(middleX, 0, middleZ) + place_;
        return turn_ * at<Scalar>(x - middleX, y, z - middleZ) + origin;
    }
    [[nodiscard]] Point placed(double x, double y, double z) const {
        return turn_ * at<Scalar>(x, y, z) + place_;
    }

    /// The chunk number (i, k) from the middle, `height` up, every other one of half the resolution, so that
    /// corners of one lie on edges of the next.
    [[nodiscard]] std::vector<Point> chunk(int i, int k, double height) const {
        const double x = (i + 0.5) * kQuads;
        const double z = (k + 0.5) * kQuads;
        const int step = (i + k) % 2 == 0 ? 1 : 2;
        std::vector<Point> corners;
        for (int b = 0; b < kQuads; b += step) {
            for (int a = 0; a < kQuads; a += step) {
                for (const auto& [da, db] :
                     {std::pair(0, 0), std::pair(step, 0), std::pair(0, step), std::pair(step, 0),
                      std::pair(0, step), std::pair(step, step)}) {
                    corners.push_back(
                        placed(x, z, i * kQuads + a + da, height, k * kQuads + b + db));
                }
            }
        }
        return corners;
    }

    /// The chunks from (-side, -side) to (side, side). Returns where their numbers begin.
    std::vector<std::uint32_t> addTo(Terrain<Scalar>& terrain, int side, double height) const {
        std::vector<std::uint32_t> firsts;
        for (int k = -side; k < side; ++k) {
            for (int i = -side; i < side; ++i) {
                const AddedTriangles added = terrain.add(chunk(i, k, height));
                EXPECT_TRUE(added.refused.empty());
                firsts.push_back(added.first);
            }
        }
        return firsts;
    }

    /// Points `above` [m] the ground at `height`: on seams along both axes, and where four chunks meet.
    [[nodiscard]] std::vector<Point> onSeams(Random& random, int side, double height, double above,
                                             int count) const {
        std::vector<Point> points;
        const double most = side * kQuads - 0.1;
        for (int i = 0; i < count; ++i) {
            double x =
                kQuads * (static_cast<int>(random.below(2 * static_cast<std::uint32_t>(side) - 1)) -
                          side + 1);
            double z = random.chance(0.1) ? 0 : random.between(-most, most);
            if (random.chance(0.5)) {
                std::swap(x, z);
            }
            Point point = placed(x, height, z);
            point[1] += static_cast<Scalar>(above);
            points.push_back(point);
        }
        return points;
    }

private:
    Eigen::Matrix<Scalar, 3, 3> turn_;
    Point place_;
};

}  // namespace hashphase::test
