// SPDX-License-Identifier: Zlib
#pragma once

// Populations of boxes, from the ordinary to the hostile. Those of float and double are compiled once
// for all test programs.

#include <tests/support/random.hpp>

#include <functional>
#include <string>
#include <vector>

namespace hashphase::test {

template <class Scalar>
struct BoxScene {
    std::string name;
    std::uint32_t count = 0;  // proxies that make it a scene in which some pairs overlap
    double mobileShare = 1;   // of proxies that ever move
    std::function<Aabb<Scalar>(Random&)> draw;                        // a box anywhere
    std::function<Aabb<Scalar>(Random&, const Aabb<Scalar>&)> nudge;  // moved a little
};

template <class Scalar>
[[nodiscard]] Aabb<Scalar> boxAround(const Vector3<double>& center, const Vector3<double>& half) {
    return {(center - half).template cast<Scalar>(), (center + half).template cast<Scalar>()};
}

template <class Scalar>
[[nodiscard]] Aabb<Scalar> makeBox(double minX, double minY, double minZ, double maxX, double maxY,
                                   double maxZ) {
    return {Vector3<double>(minX, minY, minZ).cast<Scalar>(),
            Vector3<double>(maxX, maxY, maxZ).cast<Scalar>()};
}

/// Draws boxes with middles from `low` to `high` that reach from `least` to `most` to either side.
template <class Scalar, class Corner>
[[nodiscard]] auto boxesIn(const Corner& low, const Corner& high, double least, double most) {
    return [=](Random& random) {
        const Vector3<double> center = random.pointIn(low, high);
        return boxAround<Scalar>(center, random.pointIn(least, most));
    };
}

/// Draws cubes with middles from `low` to `high` that reach `half` to either side.
template <class Scalar, class Corner>
[[nodiscard]] auto cubesIn(const Corner& low, const Corner& high, double half) {
    return [=](Random& random) {
        return boxAround<Scalar>(random.pointIn(low, high), Vector3<double>::Constant(half));
    };
}

template <class Scalar, class Draw>
[[nodiscard]] std::vector<Aabb<Scalar>> drawBoxes(Random& random, std::size_t count, Draw draw) {
    std::vector<Aabb<Scalar>> boxes;
    while (boxes.size() < count) {
        boxes.push_back(draw(random));
    }
    return boxes;
}

/// Moves by up to `step` along each axis.
template <class Scalar>
[[nodiscard]] Aabb<Scalar> shifted(Random& random, const Aabb<Scalar>& box, double step) {
    const Vector3<Scalar> by = random.pointIn(-step, step).cast<Scalar>();
    return {box.min() + by, box.max() + by};
}

/// Boxes spread evenly: sides of 1 to 2 times `scale`, middles within 7 `scale` of `middle`.
template <class Scalar>
[[nodiscard]] BoxScene<Scalar> spreadScene(std::string name, double scale, double middle);

/// A coordinate that has broken a broadphase before.
template <class Scalar>
[[nodiscard]] Scalar hostileNumber(Random& random);

template <class Scalar>
[[nodiscard]] Aabb<Scalar> hostileBox(Random& random);

/// Half of the boxes hostile, the other half small.
template <class Scalar>
[[nodiscard]] BoxScene<Scalar> hostileScene();

/// The above and many more, all that a broadphase must be right in.
template <class Scalar>
[[nodiscard]] std::vector<BoxScene<Scalar>> allBoxScenes();

}  // namespace hashphase::test
