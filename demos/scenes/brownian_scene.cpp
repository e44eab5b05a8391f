// SPDX-License-Identifier: Zlib
#include <demos/scenes/brownian_scene.hpp>

#include <cmath>
#include <utility>

namespace hashphase::demos {
namespace {

constexpr float kLongestStep = 0.2F;  // [m] a frame and axis: up to 12 m/s

Vector3<float> pointIn(Random& random, const Aabb<float>& room) {
    Vector3<float> point;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        point[axis] = random.between(room.min()[axis], room.max()[axis]);
    }
    return point;
}

// The cube at the origin in which `objects` boxes overlap `neighbours` others each on average.
// Centres may lie (a + b) / 2 apart on each axis, so a box meets n / volume * E[(a + b)^3] others.
Aabb<float> roomFor(std::size_t objects, float meanCubedSum, float neighbours) {
    const float side = std::cbrt(static_cast<float>(objects) * meanCubedSum / neighbours);
    return {Vector3<float>::Zero(), Vector3<float>::Constant(side)};
}

// Independent edges of mean 1 m: E[a + b] = 2 on each axis.
constexpr float kMeanCubedSum = 8;

Vector3<float> halfEdgesOfAboutAMetre(Random& random) {
    return 0.5F * pointIn(random, {Vector3<float>::Constant(0.5F), Vector3<float>::Constant(1.5F)});
}

// Boxes with their centres anywhere in roomOf(their number, random).
template <class RoomOf, class HalfEdges>
BrownianBoxes scatterIn(const RoomOf& roomOf, std::size_t objects, std::uint64_t seed, float step,
                        const HalfEdges& halfEdges) {
    Random random(seed);
    BrownianBoxes boxes;
    boxes.bodies.reserve(objects);
    for (std::size_t i = 0; i < objects; ++i) {
        const Aabb<float> room = roomOf(i, random);
        const Vector3<float> centre = pointIn(random, room);
        boxes.bodies.push_back({centre, halfEdges(random), step, room});
    }
    return boxes;
}

auto always(const Aabb<float>& room) {
    return [room](std::size_t /*number*/, Random& /*random*/) { return room; };
}

}  // namespace

BrownianScene::BrownianScene(BrownianBoxes boxes, std::uint64_t seed)
    // Another stream than the one that scattered the boxes.
    : bodies_(std::move(boxes.bodies)), random_(~seed) {
    filters_ = std::move(boxes.filters);
    boxes_.reserve(bodies_.size());
    for (const BrownianBoxes::Body& body : bodies_) {
        boxes_.emplace_back(body.centre - body.halfEdges, body.centre + body.halfEdges);
        bounds_.extend(body.roomForCentre.min() - body.halfEdges);
        bounds_.extend(body.roomForCentre.max() + body.halfEdges);
    }
}

void BrownianScene::advance() {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        BrownianBoxes::Body& body = bodies_[i];
        if (body.step == 0) {
            continue;
        }
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
            body.centre[axis] += random_.between(-body.step, body.step);
        }
        body.centre = body.centre.cwiseMax(body.roomForCentre.min());
        body.centre = body.centre.cwiseMin(body.roomForCentre.max());
        boxes_[i] = {body.centre - body.halfEdges, body.centre + body.halfEdges};
    }
}

BrownianBoxes withStatics(BrownianBoxes boxes, std::size_t period) {
    boxes.filters.resize(boxes.bodies.size());
    for (std::size_t i = 0; i < boxes.bodies.size(); i += period) {
        if (boxes.bodies[i].step == 0) {
            boxes.filters[i] = kStaticFilter;
        }
    }
    return boxes;
}

BrownianBoxes uniformBoxes(std::size_t objects, std::uint64_t seed) {
    return scatterIn(always(roomFor(objects, kMeanCubedSum, 2)), objects, seed, kLongestStep,
                     halfEdgesOfAboutAMetre);
}

BrownianBoxes pileBoxes(std::size_t objects, std::uint64_t seed) {
    constexpr std::size_t kPerPile = 100;
    constexpr float kSide = 1e4F;
    const Vector3<float> pileEdges = roomFor(kPerPile, kMeanCubedSum, 5).max();
    const Aabb<float> ground(Vector3<float>::Zero(), Vector3<float>(kSide, 0, kSide) - pileEdges);
    Aabb<float> pile;
    const auto pileOf = [&](std::size_t number, Random& random) {
        if (number % kPerPile == 0) {
            const Vector3<float> corner(random.between(0, ground.max().x()), 0,
                                        random.between(0, ground.max().z()));
            pile = {corner, corner + pileEdges};
        }
        return pile;
    };
    return scatterIn(pileOf, objects, seed, kLongestStep / 4, halfEdgesOfAboutAMetre);
}

BrownianBoxes logSizeBoxes(std::size_t objects, std::uint64_t seed) {
    constexpr float kSmallest = 0.1F;
    constexpr float kLargest = 30;
    // E[(a + b)^3] = 2 E[a^3] + 6 E[a^2] E[a] for log-uniform edges.
    constexpr float kLogMeanCubedSum = 5637;
    const auto halfEdges = [](Random& random) -> Vector3<float> {
        const float edge = kSmallest * std::pow(kLargest / kSmallest, random.unit());
        return Vector3<float>::Constant(edge / 2);
    };
    return scatterIn(always(roomFor(objects, kLogMeanCubedSum, 4)), objects, seed, kLongestStep,
                     halfEdges);
}

BrownianBoxes someMovingBoxes(std::size_t objects, std::uint64_t seed, std::size_t period) {
    BrownianBoxes boxes = uniformBoxes(objects, seed);
    for (std::size_t i = 0; i < objects; ++i) {
        if (i % period != 0) {
            boxes.bodies[i].step = 0;
        }
    }
    return boxes;
}

BrownianBoxes mostlyStaticBoxes(std::size_t objects, std::uint64_t seed) {
    return withStatics(someMovingBoxes(objects, seed, 10), 1);
}

BrownianBoxes restingBoxes(std::size_t objects, std::uint64_t seed) {
    return withStatics(someMovingBoxes(objects, seed, 50), 2);
}

BrownianBoxes broadmarkBoxes(std::size_t objects, std::uint64_t seed) {
    constexpr float kFilledShare = 0.1F;
    // On an axis, so that no move is longer than 2 m.
    const float step = 2 / std::sqrt(3.0F);
    const float side = std::cbrt(static_cast<float>(objects) / kFilledShare);
    const Aabb<float> room(Vector3<float>::Zero(), Vector3<float>::Constant(side));
    return scatterIn(always(room), objects, seed, step, [](Random& /*random*/) -> Vector3<float> {
        return Vector3<float>::Constant(0.5F);
    });
}

}  // namespace hashphase::demos
