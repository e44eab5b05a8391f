// SPDX-License-Identifier: Zlib
#include <demos/accuracy/sweeps/tunnelling.hpp>

#include <cmath>

namespace hashphase::demos {
namespace {

constexpr double kAslant = 0.125;  // at most, of a step
constexpr double kAcross = static_cast<double>(SweptFrame::kUnit);

// A power of two of which the whole way of everything is at most 2^23.
double unitFor(double longest) {
    return std::exp2(std::ceil(std::log2(longest)) - 23);
}

double evenUnits(double length, double unit) {
    return 2 * std::round(length / unit / 2);
}

double onLattice(double length) {
    return std::round(length / kAcross) * kAcross;
}

Aabb<float> boxOf(const Vector3<double>& low, const Vector3<double>& high) {
    return {low.cast<float>(), high.cast<float>()};
}

}  // namespace

BulletsAtWalls::BulletsAtWalls(double thickness, double ratio, Random& random) : random_(random) {
    const double window = thickness + 2 * kBulletRadius;
    unit_ = unitFor(2 + window + 2 * ratio * window);
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
    const double window = (thickness_ + bullet_) * unit_;
    const double step = step_ * unit_;
    const double halfWidth = onLattice(2 + 2 * window);
    const double radius = onLattice(kBulletRadius);
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
        const double floor = 4.0 * lane;
        const double face = drawBelow(1 / unit_) * unit_;
        const double distance = (2 * drawBelow(step_ / 2) + 1) * unit_;
        const double front = face - distance;
        const double wallMoves = lane % 2 == 0 ? 0 : (drawBelow(step_) - step_ / 2) * unit_;
        const double aslant =
            onLattice(static_cast<double>(random_.between(-kAslant, kAslant)) * step);
        const double across =
            onLattice(static_cast<double>(random_.between(-1, 1)) - aslant * distance / step);
        const double height = onLattice(floor + static_cast<double>(random_.between(0.5F, 2.5F)));
        frame_.objects[lane] = {boxOf({front - bullet_ * unit_, height - radius, across - radius},
                                      {front, height + radius, across + radius}),
                                Vector3<double>(step + wallMoves, 0, aslant).cast<float>()};
        frame_.objects[kLanes + lane] = {
            boxOf({face, floor, -halfWidth}, {face + thickness_ * unit_, floor + 3, halfWidth}),
            Vector3<double>(wallMoves, 0, 0).cast<float>()};
    }
}

std::vector<TunnellingPoint> measureTunnelling(const TunnellingPlan& plan,
                                               std::span<const SweepMethod> methods,
                                               std::uint64_t seed, const TellProgress& tell) {
    Random random(seed);
    std::vector<TunnellingPoint> points;
    for (const double thickness : plan.thicknesses) {
        for (const double ratio : plan.ratios) {
            tell(static_cast<double>(points.size()) /
                     static_cast<double>(plan.thicknesses.size() * plan.ratios.size()),
                 "bullets at walls");
            TunnellingPoint point{thickness, ratio, std::vector<SweepTally>(methods.size())};
            BulletsAtWalls lanes(thickness, ratio, random);
            const SweepFinders finders = makeFinders(methods, lanes.frame());
            for (int frame = 0; frame < plan.frames; ++frame) {
                judgeFrame(methods, finders, lanes.frame(), frame, point.tallies);
                lanes.advance();
            }
            points.push_back(std::move(point));
        }
    }
    return points;
}

}  // namespace hashphase::demos
