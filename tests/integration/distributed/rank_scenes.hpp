// SPDX-License-Identifier: Zlib
#pragma once

// Populations that ranks find hard to share.

#include <broadphase/aabb.hpp>
#include <tests/support/random.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace hashphase::test {

/// Boxes that move, frame by frame, the same in every process. About as many pairs as boxes.
template <class Scalar>
class MovingBoxes {
public:
    enum class Kind {
        uniform,
        clustered,   // nearly all in a few small balls
        travelling,  // one cluster that crosses all others
        corner,      // all in one corner, and one far away in the other
        log_sizes,   // sizes over six orders of magnitude, and planes of 1e18
    };
    static constexpr Kind kKinds[] = {Kind::uniform, Kind::clustered, Kind::travelling,
                                      Kind::corner, Kind::log_sizes};
    static const char* nameOf(Kind kind) {
        constexpr const char* kNames[] = {"uniform", "clustered", "travelling", "corner",
                                          "log_sizes"};
        return kNames[static_cast<int>(kind)];
    }

    MovingBoxes(Kind kind, std::size_t count, std::uint64_t seed) : kind_(kind), random_(seed) {
        const double side = std::cbrt(static_cast<double>(count)) * 2;
        while (boxes.size() < count) {
            boxes.push_back(draw(side, boxes.size(), count));
        }
    }

    /// Most move a little.
    void advance() {
        ++frame_;
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            if (!random_.chance(0.8) || isPlane(i)) {
                continue;
            }
            Vector3<double> step = random_.pointIn(-0.3, 0.3);
            if (kind_ == Kind::travelling && i % 4 != 0) {
                step[0] += 2;
            }
            const Vector3<Scalar> by = step.cast<Scalar>();
            boxes[i] = Aabb<Scalar>(boxes[i].min() + by, boxes[i].max() + by);
        }
    }

    std::vector<Aabb<Scalar>> boxes;

private:
    [[nodiscard]] bool isPlane(std::size_t i) const { return kind_ == Kind::log_sizes && i < 2; }

    Aabb<Scalar> draw(double side, std::size_t i, std::size_t count) {
        Vector3<double> at = random_.pointIn(0, side);
        double half = random_.between(0.3, 0.9);
        if (isPlane(i)) {
            const double far = 1e18;
            const double height = i == 0 ? 0 : side / 2;
            return {Vector3<double>(-far, -far, height - 0.1).cast<Scalar>(),
                    Vector3<double>(far, far, height + 0.1).cast<Scalar>()};
        }
        switch (kind_) {
            case Kind::uniform:
                break;
            case Kind::clustered:
                if (i % 8 != 0) {
                    const auto ball = static_cast<double>(i % 5);
                    const Vector3<double> middle(0.1 + 0.17 * ball, i % 2 == 0 ? 0.2 : 0.7,
                                                 0.15 * ball);
                    const double radius = side * (0.05 + 0.02 * ball);
                    at = side * middle + random_.pointIn(-radius, radius);
                    half *= 0.5;
                }
                break;
            case Kind::travelling:
                if (i % 4 != 0) {
                    at = Vector3<double>(0, side / 2, side / 2) +
                         random_.pointIn(-side / 6, side / 6);
                    half *= 0.4;
                }
                break;
            case Kind::corner:
                at = i + 1 == count ? Vector3<double>::Constant(1e6) : Vector3<double>(at / 8);
                half /= 8;
                break;
            case Kind::log_sizes:
                half = 0.5 * random_.logBetween(1e-5, 10) * random_.between(0, 1);
                break;
        }
        const Vector3<double> extent = Vector3<double>::Constant(half);
        return {(at - extent).template cast<Scalar>(), (at + extent).template cast<Scalar>()};
    }

    Kind kind_;
    Random random_;
    int frame_ = 0;
};

}  // namespace hashphase::test
