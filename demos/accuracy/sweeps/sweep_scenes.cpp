// SPDX-License-Identifier: Zlib
#include <demos/accuracy/sweeps/sweep_experiment.hpp>

#include <demos/scenes/physics_world.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hashphase::demos {
namespace {

constexpr double kBulletRadius = 0.005;  // [m]
constexpr std::uint32_t kLanes = 8;
constexpr float kHeight = 16;                 // of the air [m]
constexpr float kGroundOfObject = 16.0F / 3;  // [m^2]

double evenUnits(double length, double unit) {
    return 2 * std::round(length / unit / 2);
}

template <class Real>
Real onLattice(Real length) {
    constexpr auto unit = static_cast<Real>(SweptFrame::kUnit);
    return std::round(length / unit) * unit;
}

Vector3<float> onLattice(const Vector3<float>& point) {
    return {onLattice(point.x()), onLattice(point.y()), onLattice(point.z())};
}

Aabb<float> boxOf(const Vector3<double>& low, const Vector3<double>& high) {
    return {low.cast<float>(), high.cast<float>()};
}

}  // namespace

BulletsAtWalls::BulletsAtWalls(double thickness, double ratio, Random& random) : random_(random) {
    const double window = thickness + 2 * kBulletRadius;
    // A power of two of which the whole way of everything is at most 2^23.
    unit_ = std::exp2(std::ceil(std::log2(2 + window + 2 * ratio * window)) - 23);
    thickness_ = evenUnits(thickness, unit_);
    bullet_ = evenUnits(2 * kBulletRadius, unit_);
    step_ = evenUnits(ratio * (thickness_ + bullet_), 1);
    frame_.unit[0] = static_cast<float>(unit_);
    frame_.movers = 2 * kLanes;
    frame_.objects.resize(frame_.movers);
    advance();
}

double BulletsAtWalls::drawBelow(double limit) {
    return std::floor(static_cast<double>(random_.unit()) * limit);
}

// Lengths along the step are even numbers of units and the distance to go is an odd one: so each
// moment is as likely as any other, and none is on the border between seen and missed.
void BulletsAtWalls::advance() {
    constexpr double aslantAtMost = 0.125;  // of a step
    const double window = (thickness_ + bullet_) * unit_;
    const double step = step_ * unit_;
    const double halfWidth = onLattice(2 + 2 * window);
    const double radius = onLattice(kBulletRadius);
    const auto between = [this](double low, double high) {
        return static_cast<double>(
            random_.between(static_cast<float>(low), static_cast<float>(high)));
    };
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
        const double floor = 4.0 * lane;
        const double face = drawBelow(1 / unit_) * unit_;
        const double distance = (2 * drawBelow(step_ / 2) + 1) * unit_;
        const double front = face - distance;
        const double wallMoves = lane % 2 == 0 ? 0 : (drawBelow(step_) - step_ / 2) * unit_;
        const double aslant = onLattice(between(-aslantAtMost, aslantAtMost) * step);
        const double across = onLattice(between(-1, 1) - aslant * distance / step);
        const double height = onLattice(floor + between(0.5, 2.5));
        frame_.objects[lane] = {boxOf({front - bullet_ * unit_, height - radius, across - radius},
                                      {front, height + radius, across + radius}),
                                Vector3<double>(step + wallMoves, 0, aslant).cast<float>()};
        frame_.objects[kLanes + lane] = {
            boxOf({face, floor, -halfWidth}, {face + thickness_ * unit_, floor + 3, halfWidth}),
            Vector3<double>(wallMoves, 0, 0).cast<float>()};
    }
}

// Walls beside each other, and a sphere before each. Nothing pulls at them.
int countTunnelled(double thickness, double ratio, bool isContinuous, Random& random) {
    constexpr btScalar frame = btScalar(1) / 60;  // [s]
    constexpr auto radius = static_cast<btScalar>(kBulletRadius);
    const auto thick = static_cast<btScalar>(thickness);
    const auto step = static_cast<btScalar>(ratio * (thickness + 2 * kBulletRadius));
    PhysicsWorld world(physicsBroadphase(kDbvtName), ListOrder::asShipped);
    world.world().setGravity(btVector3(0, 0, 0));
    WorldContents& contents = world.contents();
    auto& wall = contents.addShape<btBoxShape>(btVector3(thick / 2, 1, 1));
    auto& sphere = contents.addShape<btSphereShape>(radius);
    std::vector<const btRigidBody*> spheres;
    for (int lane = 0; lane < kFlyingBodies; ++lane) {
        const btScalar across = btScalar(4) * static_cast<btScalar>(lane);
        const btScalar distance = step * (btScalar(1) - random.unit());
        contents.addBody(wall, 0, btVector3(thick / 2, 0, across));
        btRigidBody& body = contents.addBody(sphere, 1, btVector3(-distance - radius, 0, across));
        body.setLinearVelocity(btVector3(step / frame, 0, 0));
        if (isContinuous) {
            body.setCcdMotionThreshold(radius);
            body.setCcdSweptSphereRadius(radius);
        }
        spheres.push_back(&body);
    }
    // Until they have met the wall, and could be through.
    world.step(frame, 3 + static_cast<int>(std::ceil(1 / ratio)));
    return static_cast<int>(
        std::count_if(spheres.begin(), spheres.end(), [thick](const btRigidBody* each) {
            return each->getWorldTransform().getOrigin().x() > thick;
        }));
}

FastMovers::FastMovers(std::uint32_t objects, std::uint32_t movers, double motion,
                       std::uint64_t seed)
    : random_(seed),
      side_(std::sqrt(static_cast<float>(objects) * kGroundOfObject)),
      motion_(static_cast<float>(motion)) {
    frame_.movers = movers;
    for (std::uint32_t i = 0; i < objects; ++i) {
        frame_.objects.push_back({i < movers ? drawBox(0.2F, 0.8F) : drawBox(0.4F, 1.2F)});
    }
    advance();
}

Aabb<float> FastMovers::drawBox(float smallest, float largest) {
    const auto edge = [&] { return random_.between(smallest, largest); };
    const Vector3<float> size = onLattice(Vector3<float>(edge(), edge(), edge()));
    const Vector3<float> low = onLattice(Vector3<float>(
        random_.between(0, side_), random_.between(0, kHeight), random_.between(0, side_)));
    return {low, low + size};
}

// Draws until each way ends within the landscape.
void FastMovers::advance() {
    const Aabb<float> landscape(Vector3<float>::Zero(), Vector3<float>(side_, kHeight, side_));
    for (std::uint32_t i = 0; i < frame_.movers; ++i) {
        MovingBox<float>& mover = frame_.objects[i];
        mover.box.translate(mover.displacement);
        do {
            const float heading = random_.between(0, 2 * std::numbers::pi_v<float>);
            const float climb = random_.between(-motion_ / 2, motion_ / 2);
            mover.displacement =
                onLattice({motion_ * std::cos(heading), climb, motion_ * std::sin(heading)});
        } while (!landscape.contains(mover.box.min() + mover.displacement));
    }
}

// --- Truth -------------------------------------------------------------------------------------------

std::optional<Fraction> exactContact(const SweptFrame& frame, std::uint32_t a, std::uint32_t b) {
    const MovingBox<float>& one = frame.objects[a];
    const MovingBox<float>& other = frame.objects[b];
    WholePoint closing;
    WholePoint low;
    WholePoint high;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto axis = static_cast<Eigen::Index>(i);
        const auto units = [&](const Vector3<float>& point) {
            return wholeUnits(point[axis], frame.unit[i], 0x1p24F);
        };
        closing[i] = units(one.displacement) - units(other.displacement);
        low[i] = units(other.box.min()) - units(one.box.max());
        high[i] = units(other.box.max()) - units(one.box.min());
    }
    return exactEntry(closing, low, high);
}

SweepTruth findTruth(const SweptFrame& frame) {
    std::vector<Aabb<float>> ways;
    for (const MovingBox<float>& each : frame.objects) {
        ways.push_back(wayBox(each));
    }
    std::vector<PairKey> candidates;
    findExactPairs(ReferenceMethod::kSweep, ways, {}, candidates);
    SweepTruth truth;
    for (const PairKey pair : candidates) {
        if (firstOf(pair) >= frame.movers) {
            continue;
        }
        const std::optional<Fraction> moment = exactContact(frame, firstOf(pair), secondOf(pair));
        if (moment && moment->numerator == 0) {
            truth.older.push_back(pair);
        } else if (moment) {
            truth.contacts.push_back(pair);
            truth.moments.push_back(*moment);
        }
    }
    return truth;
}

}  // namespace hashphase::demos
