// SPDX-License-Identifier: Zlib
#include <demos/accuracy/origin/origin_settle.hpp>

#include <demos/accuracy/timing.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string_view>

namespace hashphase::demos {
namespace {

constexpr std::size_t kBalls = 16;
constexpr double kRadius = 0.5;
constexpr int kSteps = 300;  // of 1/60 s

using Places = std::array<Eigen::Vector3d, kBalls>;

/// Where the ball ought to rest, on the floor at height 0.
Eigen::Vector3d restOf(std::size_t ball) {
    const auto i = static_cast<double>(ball);
    return {2 * i - 16 + i / 32, kRadius, 3 - i / 64};
}

void fill(WorldContents& contents, double offset) {
    constexpr btScalar kHalfFloor = 32;
    const auto at = [offset](const Eigen::Vector3d& place) {
        return btVector3(static_cast<btScalar>(place.x() + offset),
                         static_cast<btScalar>(place.y() + offset),
                         static_cast<btScalar>(place.z() + offset));
    };
    auto& floor = contents.addShape<btBoxShape>(btVector3(kHalfFloor, kHalfFloor, kHalfFloor));
    contents.addBody(floor, 0, at({0, -double{kHalfFloor}, 0}));
    auto& sphere = contents.addShape<btSphereShape>(static_cast<btScalar>(kRadius));
    for (std::size_t i = 0; i < kBalls; ++i) {
        const double drop = 0.5 + static_cast<double>(i) / 16;
        contents.addBody(sphere, 1, at(restOf(i) + Eigen::Vector3d(0, drop, 0)));
    }
}

Places placesOf(const WorldContents& contents) {
    Places places;
    for (std::size_t i = 0; i < kBalls; ++i) {
        const btVector3& place = contents.bodies()[i + 1]->getWorldTransform().getOrigin();
        places[i] = {place.x(), place.y(), place.z()};
    }
    return places;
}

/// The largest distance between the two places of a ball; infinite where a place is not a number.
double farthest(const Places& a, const Places& b) {
    double most = 0;
    for (std::size_t i = 0; i < kBalls; ++i) {
        const double distance = (a[i] - b[i]).norm();
        if (std::isnan(distance)) {
            return std::numeric_limits<double>::infinity();
        }
        most = std::max(most, distance);
    }
    return most;
}

Places restPlaces(double offset) {
    Places places;
    for (std::size_t i = 0; i < kBalls; ++i) {
        places[i] = restOf(i).array() + offset;
    }
    return places;
}

int settleStep(const std::vector<Places>& course) {
    constexpr double kStill = 1e-3;  // [m]
    auto step = static_cast<int>(course.size());
    while (step > 0 &&
           farthest(course[static_cast<std::size_t>(step) - 1], course.back()) <= kStill) {
        --step;
    }
    return step + 1;
}

}  // namespace

std::vector<SettleMethod> settleMethods() {
    const std::vector<PhysicsBroadphase> all = physicsBroadphases();
    const auto named = [&all](std::string_view name) {
        return *std::find_if(all.begin(), all.end(),
                             [name](const auto& each) { return each.name == name; });
    };
    return {{"Bullet in float, btDbvtBroadphase", named(kDbvtName), false},
            {"Bullet in float, hashphase", named(kHashName), false},
            {"Bullet in float, hashphase, origin shifted", named(kHashName), true}};
}

std::vector<SettleOutcome> settleAt(double offset, std::span<const SettleMethod> methods) {
    constexpr btScalar kStep = btScalar(1) / btScalar(60);
    std::vector<std::unique_ptr<PhysicsWorld>> worlds;
    std::vector<std::function<void()>> timed;
    for (const SettleMethod& method : methods) {
        worlds.push_back(std::make_unique<PhysicsWorld>(method.broadphase, ListOrder::asShipped));
        fill(worlds.back()->contents(), method.shiftsOrigin ? 0 : offset);
        timed.emplace_back([world = worlds.back().get()] { world->step(kStep); });
    }
    std::vector<std::vector<Places>> courses(methods.size());
    const auto look = [&] {
        for (std::size_t i = 0; i < worlds.size(); ++i) {
            courses[i].push_back(placesOf(worlds[i]->contents()));
        }
    };
    const std::vector<Spread> times = timeInTurn(
        kSteps, 0, [&](int) { look(); }, timed);
    look();

    std::vector<SettleOutcome> outcomes(methods.size());
    for (std::size_t i = 0; i < methods.size(); ++i) {
        const double seenFrom = methods[i].shiftsOrigin ? 0 : offset;
        outcomes[i].positionError = farthest(courses[i].back(), restPlaces(seenFrom));
        outcomes[i].settleStep = settleStep(courses[i]);
        outcomes[i].stepMs = times[i];
        outcomes[i].localState = stateHash(worlds[i]->contents());
    }
    return outcomes;
}

}  // namespace hashphase::demos
