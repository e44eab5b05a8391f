// SPDX-License-Identifier: Zlib
#include <demos/accuracy/sweeps/fast_movers.hpp>

#include <demos/accuracy/timing.hpp>

#include <cmath>
#include <numbers>

namespace hashphase::demos {
namespace {

constexpr float kHeight = 16;                 // [m]
constexpr float kGroundOfObject = 16.0F / 3;  // [m^2]
constexpr int kWarmUp = 4;

float onLattice(float length) {
    return std::round(length / SweptFrame::kUnit) * SweptFrame::kUnit;
}

Vector3<float> onLattice(const Vector3<float>& point) {
    return {onLattice(point.x()), onLattice(point.y()), onLattice(point.z())};
}

}  // namespace

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
    const auto edge = [&] { return onLattice(random_.between(smallest, largest)); };
    const Vector3<float> size(edge(), edge(), edge());
    const Vector3<float> low = onLattice(Vector3<float>(
        random_.between(0, side_), random_.between(0, kHeight), random_.between(0, side_)));
    return {low, low + size};
}

void FastMovers::advance() {
    for (std::uint32_t i = 0; i < frame_.movers; ++i) {
        aim(frame_.objects[i]);
    }
}

// Draws until the way ends within the landscape.
void FastMovers::aim(MovingBox<float>& mover) {
    mover.box.translate(mover.displacement);
    const auto isWithin = [](float place, float end) { return place >= 0 && place <= end; };
    Vector3<float> end;
    do {
        const float heading = random_.between(0, 2 * std::numbers::pi_v<float>);
        const float climb = random_.between(-motion_ / 2, motion_ / 2);
        mover.displacement =
            onLattice({motion_ * std::cos(heading), climb, motion_ * std::sin(heading)});
        end = mover.box.min() + mover.displacement;
    } while (!isWithin(end.x(), side_) || !isWithin(end.y(), kHeight) || !isWithin(end.z(), side_));
}

std::vector<MotionResult> measureFastMovers(const FastMoversPlan& plan,
                                            std::span<const SweepMethod> methods,
                                            std::uint64_t seed, const TellProgress& tell) {
    std::vector<MotionResult> results;
    for (const FastMotion& motion : plan.motions) {
        FastMovers scene(plan.objects, plan.movers, motion.cells, seed);
        MotionResult result{motion.cells, std::vector<SweepTally>(methods.size()), {}};
        const SweepFinders finders = makeFinders(methods, scene.frame());
        for (int frame = 0; frame < motion.judgedFrames; ++frame) {
            judgeFrame(methods, finders, scene.frame(), 0, result.tallies);
            scene.advance();
        }
        std::vector<std::function<void()>> steps;
        for (const auto& finder : finders) {
            steps.emplace_back([&finder, &scene] { finder->step(scene.frame()); });
        }
        const auto begin = [&](int frame) {
            scene.advance();
            const double done = static_cast<double>(results.size()) +
                                frame / static_cast<double>(plan.timedFrames + kWarmUp);
            tell(done / static_cast<double>(plan.motions.size()), "fast movers");
        };
        result.milliseconds = timeInTurn(plan.timedFrames, kWarmUp, begin, steps);
        results.push_back(std::move(result));
    }
    return results;
}

}  // namespace hashphase::demos
