// SPDX-License-Identifier: Zlib
#include <demos/accuracy/physics/physics_experiments.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace hashphase::demos {
namespace {

constexpr double kGravity = 10;  // Bullet's default [m/s^2]
constexpr double kRadius = 0.5;  // of all balls
constexpr std::size_t kBalls = 25;
constexpr std::size_t kSpheres = 216;  // 6 x 6 x 6

double square(double number) {
    return number * number;
}

double speedSquared(const btRigidBody& body) {
    const btVector3& v = body.getLinearVelocity();
    return square(v.x()) + square(v.y()) + square(v.z());
}

void neverSleep(WorldContents& contents) {
    for (const auto& body : contents.bodies()) {
        body->setActivationState(DISABLE_DEACTIVATION);
    }
}

// Of balls that are bodies first, first + 1, ...: the mean of a squared error.
template <class ErrorOf>
double meanSquare(const WorldContents& contents, std::size_t first, const ErrorOf& errorOf) {
    double sum = 0;
    for (std::size_t i = first; i < contents.bodies().size(); ++i) {
        sum += square(errorOf(*contents.bodies()[i], i - first));
    }
    return sum / static_cast<double>(contents.bodies().size() - first);
}

// --- 666 spheres dropped into a box ------------------------------------------------------------------

constexpr std::size_t kBoxParts = 5;  // floor and walls are the first bodies
constexpr double kBoxHalfWidth = 3.5;

void fillDrop(WorldContents& contents, std::uint64_t seed) {
    addOpenBox(contents, static_cast<btScalar>(kBoxHalfWidth));
    addLattice(contents, kSpheres, 1.1F, 0.6F, 0.04F, seed);
    neverSleep(contents);
}

double overlapWithBox(const btVector3& centre) {
    double squared = square(std::max(0.0, kRadius - centre.y()));
    for (const btScalar aside : {centre.x(), centre.z()}) {
        squared += square(std::max(0.0, std::abs(aside) + kRadius - kBoxHalfWidth));
    }
    return squared;
}

/// The squared depths of all overlaps, a ball [mm^2]: brute force in double precision.
double overlapSquared(const WorldContents& contents, double /*seconds*/) {
    constexpr double kSquareMillimetres = 1e6;
    const auto bodies = contents.bodies();
    double sum = 0;
    for (std::size_t i = kBoxParts; i < bodies.size(); ++i) {
        const btVector3& a = bodies[i]->getWorldTransform().getOrigin();
        sum += overlapWithBox(a);
        for (std::size_t j = kBoxParts; j < i; ++j) {
            const btVector3& b = bodies[j]->getWorldTransform().getOrigin();
            const double squared = square(double{a.x()} - b.x()) + square(double{a.y()} - b.y()) +
                                   square(double{a.z()} - b.z());
            if (squared < square(2 * kRadius)) {
                sum += square(2 * kRadius - std::sqrt(squared));
            }
        }
    }
    return kSquareMillimetres * sum / static_cast<double>(bodies.size() - kBoxParts);
}

// --- A ball shot at 666 spheres that float in space ---------------------------------------------------

constexpr double kShot = 10;  // [m/s]

void fillElastic(WorldContents& contents, std::uint64_t seed) {
    contents.world().setGravity(btVector3(0, 0, 0));
    addLattice(contents, kSpheres, 1.3F, 0, 0.05F, seed);
    auto& ball = contents.addShape<btSphereShape>(static_cast<btScalar>(kRadius));
    contents.addBody(ball, 1, btVector3(-8, 3, 0.25F))
        .setLinearVelocity(btVector3(static_cast<btScalar>(kShot), 0, 0));
    for (const auto& body : contents.bodies()) {
        body->setRestitution(1);
        body->setFriction(0);
    }
    neverSleep(contents);
}

double energyDriftSquared(const WorldContents& contents, double /*seconds*/) {
    double energy = 0;
    for (const auto& body : contents.bodies()) {
        const btVector3& spin = body->getAngularVelocity();
        const double inertia = 0.4 * square(kRadius);
        energy += speedSquared(*body) / 2 + inertia * double{spin.length2()} / 2;
    }
    const double before = square(kShot) / 2;
    return square(energy / before - 1);
}

double momentumDriftSquared(const WorldContents& contents, double /*seconds*/) {
    double x = -kShot;
    double y = 0;
    double z = 0;
    for (const auto& body : contents.bodies()) {
        x += body->getLinearVelocity().x();
        y += body->getLinearVelocity().y();
        z += body->getLinearVelocity().z();
    }
    return (square(x) + square(y) + square(z)) / square(kShot);
}

// --- Balls that bounce for ever -----------------------------------------------------------------------

void fillBounce(WorldContents& contents, std::uint64_t /*seed*/) {
    addBouncingBalls(contents, kBalls);
    neverSleep(contents);
}

double bounceEnergySquared(const WorldContents& contents, double /*seconds*/) {
    return meanSquare(contents, 1, [](const btRigidBody& body, std::size_t ball) {
        const double height = body.getWorldTransform().getOrigin().y() - kRadius;
        const double before = kGravity * (bouncingHeight(ball) - kRadius);
        return (speedSquared(body) / 2 + kGravity * height) / before - 1;
    });
}

double bounceHeightSquared(const WorldContents& contents, double seconds) {
    return meanSquare(contents, 1, [seconds](const btRigidBody& body, std::size_t ball) {
        const double fall = bouncingHeight(ball) - kRadius;
        const double down = std::sqrt(2 * fall / kGravity);  // from top to ground [s]
        const double sinceTop = std::fmod(seconds + down, 2 * down) - down;
        const double height = bouncingHeight(ball) - kGravity * square(sinceTop) / 2;
        return body.getWorldTransform().getOrigin().y() - height;
    });
}

// --- Balls that slide, until friction has them roll ---------------------------------------------------

constexpr double kFriction = 0.25;

double slidingSpeed(std::size_t ball) {
    return 2 + 0.125 * static_cast<double>(ball);
}

void fillRoll(WorldContents& contents, std::uint64_t /*seed*/) {
    auto& plane = contents.addShape<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0));
    contents.addBody(plane, 0, btVector3(0, 0, 0)).setFriction(1);
    auto& sphere = contents.addShape<btSphereShape>(static_cast<btScalar>(kRadius));
    for (std::size_t i = 0; i < kBalls; ++i) {
        const btVector3 place(0, static_cast<btScalar>(kRadius), 2 * static_cast<btScalar>(i));
        btRigidBody& body = contents.addBody(sphere, 1, place);
        body.setFriction(static_cast<btScalar>(kFriction));
        body.setLinearVelocity(btVector3(static_cast<btScalar>(slidingSpeed(i)), 0, 0));
    }
    neverSleep(contents);
}

// Friction slows the ball and spins it until both agree, at 5/7 of the speed it began with.
double rollSpeedSquared(const WorldContents& contents, double seconds) {
    return meanSquare(contents, 1, [seconds](const btRigidBody& body, std::size_t ball) {
        const double before = slidingSpeed(ball);
        const double speed = std::max(before * 5 / 7, before - kFriction * kGravity * seconds);
        return (body.getLinearVelocity().x() - speed) / before;
    });
}

// --- Free fall ----------------------------------------------------------------------------------------

void fillFall(WorldContents& contents, std::uint64_t /*seed*/) {
    auto& sphere = contents.addShape<btSphereShape>(static_cast<btScalar>(kRadius));
    for (std::size_t i = 0; i < kBalls; ++i) {
        contents.addBody(sphere, 1, btVector3(2 * static_cast<btScalar>(i), 0, 0));
    }
    neverSleep(contents);
}

double fallSquared(const WorldContents& contents, double seconds) {
    constexpr double kSquareMillimetres = 1e6;
    return kSquareMillimetres *
           meanSquare(contents, 0, [seconds](const btRigidBody& body, std::size_t /*ball*/) {
               return body.getWorldTransform().getOrigin().y() + kGravity * square(seconds) / 2;
           });
}

}  // namespace

std::vector<PhysicsTask> physicsTasks() {
    return {
        {"drop",
         std::to_string(kSpheres) + " spheres dropped into a box",
         fillDrop,
         {{"penetration", "overlap of a ball with others and the box", "mm", overlapSquared}}},
        {"elastic",
         "A ball shot at " + std::to_string(kSpheres) + " spheres, no gravity, no loss",
         fillElastic,
         {{"energy", "energy gained or lost, as a share", "", energyDriftSquared},
          {"momentum", "momentum gained or lost, as a share", "", momentumDriftSquared}}},
        {"bounce",
         std::to_string(kBalls) + " balls that bounce without loss",
         fillBounce,
         {{"energy", "energy gained or lost, as a share", "", bounceEnergySquared},
          {"height", "height against the law of falling bodies", "m", bounceHeightSquared}}},
        {"roll",
         std::to_string(kBalls) + " sliding balls that begin to roll",
         fillRoll,
         {{"speed", "speed against the law of friction, as a share", "", rollSpeedSquared}}},
        {"fall",
         std::to_string(kBalls) + " balls in free fall",
         fillFall,
         {{"place", "place against the law of falling bodies", "mm", fallSquared}}},
    };
}

}  // namespace hashphase::demos
