// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/effects_workload.hpp>

#include <demos/compare/reference_pairs.hpp>
#include <demos/report/frame_clock.hpp>
#include <demos/scenes/random.hpp>
#include <integration/effects/simulation.hpp>
#include <tests/benchmarks/effects_by_hand.hpp>
#include <tests/support/camera_matrices.hpp>

#include <bit>
#include <cmath>
#include <numbers>

namespace hashphase::benchmarks {
namespace {

constexpr double kPaperSpheres = 30'000;
constexpr double kPaperSide = 400;  // [m]

constexpr int kRoundFrames = 20;
constexpr int kSettlingFrames = 4;      // until all have met and tables have their sizes
constexpr float kLargestGap = 0x1p16F;  // [bytes]

constexpr Answer kDeath = Answer{1} << 63;  // of the pair in the other bits

constexpr EffectSet kSimulated =
    EffectSet::all() - EffectSet{Effect::rotation, Effect::friction};  // Bullet's alone

SceneEffects effectsOf(EffectSet declared, const RoamingSpheres& spheres) {
    SceneEffects effects;
    for (const Effect effect : kAllEffects) {
        if (declared.contains(effect)) {
            effects.declare(effect);
        }
    }
    effects.motion->bounds = spheres.bounds.cast<double>();
    if (effects.proximity) {
        effects.proximity = {.radius = static_cast<double>(RoamingSpheres::kSight),
                             .colourCount = RoamingSpheres::kColours};
    }
    return effects;
}

/// Spheres in a Simulation.
class Simulated final : public EffectsContestant {
public:
    Simulated(EffectSet own, EffectSet declared, const RoamingSpheres& spheres)
        : own_(own), simulation_(effectsOf(declared, spheres)) {
        for (std::size_t i = 0; i < spheres.positions.size(); ++i) {
            ids_.push_back(simulation_.add({.position = spheres.positions[i],
                                            .radius = spheres.radii[i],
                                            .velocity = spheres.velocities[i],
                                            .effects = own == declared ? EffectSet::all() : own}));
            if (own.contains(Effect::proximity)) {
                simulation_.observers().setColour(ids_.back().index, spheres.colours[i]);
            }
        }
    }

    void advance(const ConvexRegion<float>& view) override {
        if (own_.contains(Effect::culling)) {
            simulation_.observers().setView(view);
        }
        simulation_.advance(RoamingSpheres::kTimeStep);
    }

    [[nodiscard]] Vector3<float> position(std::uint32_t body) const override {
        return simulation_.position(ids_[body]);
    }

    void listFinds(std::vector<Answer>& finds) const override {
        if (own_.contains(Effect::pairs)) {
            listChanges(simulation_.pairChanges(), finds);
        } else if (own_.contains(Effect::culling)) {
            simulation_.observers().culler().forEach(
                [&](std::uint32_t body) { finds.push_back(body); });
        } else {
            listColours(simulation_.observers().colours(), finds);
        }
    }

private:
    EffectSet own_;
    Simulation<float> simulation_;
    std::vector<BodyId> ids_;
};

// A camera in the middle that sees a tenth of the square and turns.
ConvexRegion<float> viewOf(const Aabb<float>& bounds, int frame) {
    const auto side = static_cast<double>(bounds.sizes().maxCoeff());
    test::CameraLens lens;
    lens.fieldOfView = 0.9;
    lens.farPlane = 0.37 * side;
    const double heading = 0.37 * frame;
    const Vector3<double> ahead(std::cos(heading), -0.1, std::sin(heading));
    const Vector3<double> eye = bounds.center().cast<double>() + Vector3<double>(0, 15, 0);
    return frustumRegion<float>(test::cameraMatrix<float>(lens, eye, eye + ahead), lens.depthRange);
}

}  // namespace

RoamingSpheres::RoamingSpheres(std::size_t count, std::uint64_t seed) {
    constexpr float kSlowest = 5;   // [m/s]
    constexpr float kFastest = 15;  // [m/s]
    constexpr float kPi = std::numbers::pi_v<float>;
    const auto side = static_cast<float>(
        kPaperSide * std::sqrt(static_cast<double>(count) / kPaperSpheres) + 2 * kRadius);
    bounds = {Vector3<float>::Constant(kRadius),
              Vector3<float>(side - kRadius, 2 * kRadius, side - kRadius)};
    demos::Random random(seed);
    for (std::size_t i = 0; i < count; ++i) {
        const Vector3<float> share(random.unit(), random.unit(), random.unit());
        positions.emplace_back(bounds.min() + share.cwiseProduct(bounds.sizes()));
        const float heading = random.between(-kPi, kPi);
        const float speed = random.between(kSlowest, kFastest);
        velocities.emplace_back(speed * std::cos(heading), random.between(-kRadius, kRadius),
                                speed * std::sin(heading));
        radii.push_back(kRadius * random.between(0.9F, 1.1F));
        colours.push_back(static_cast<std::uint32_t>(i % kColours));
    }
}

std::vector<ContestantKind> effectsKinds() {
    const auto kind = [](std::string_view name, const char* title, const char* description) {
        ContestantKind made;
        made.name = name;
        made.title = title;
        made.description = description;
        made.package = "this build";
        made.ours = name == kDeclared || name == kNobody;
        return made;
    };
    return {kind(kByHand, "Grid and Pairs, Culler or RarestColour",
                 "a loop over the bodies, and what the scene's effect needs"),
            kind(kDeclared, "Simulation", "the scene's own effects are declared"),
            kind(kNobody, "Simulation", "all are declared, bodies take part in the scene's own"),
            kind(kByHandAgain, "as by-hand", "tells what differs by chance")};
}

void listChanges(const PairChanges& changes, std::vector<Answer>& finds) {
    for (const ProxyPair& pair : changes.born) {
        finds.push_back(demos::pairKey(pair.first.index, pair.second.index));
    }
    for (const ProxyPair& pair : changes.died) {
        finds.push_back(kDeath | demos::pairKey(pair.first.index, pair.second.index));
    }
}

void listColours(std::span<const std::uint32_t> colours, std::vector<Answer>& finds) {
    for (std::size_t body = 0; body < colours.size(); ++body) {
        finds.push_back(Answer{body} << 32 | colours[body]);
    }
}

EffectsWorkload::EffectsWorkload(EffectSet own, std::size_t objects, std::uint64_t seed)
    : own_(own),
      seed_(seed),
      spheres_(objects, seed),
      view_(viewOf(spheres_.bounds, 0)),
      reference_(make(kByHand)),
      random_(seed) {}

std::unique_ptr<EffectsContestant> EffectsWorkload::make(std::string_view name) {
    if (name == kByHand || name == kByHandAgain) {
        return makeByHand(own_, spheres_);
    }
    return std::make_unique<Simulated>(own_, name == kDeclared ? own_ : kSimulated, spheres_);
}

void EffectsWorkload::add(const ContestantKind& kind) {
    names_.push_back(kind.name);
    contestants_.push_back(make(kind.name));
}

void EffectsWorkload::beginRound() {
    const std::size_t count = contestants_.size();
    contestants_.clear();
    contestants_.resize(count);
    gaps_.clear();
    spheres_ = RoamingSpheres(objects(), ++seed_);
    reference_ = make(kByHand);
    const auto first = static_cast<std::size_t>(random_.unit() * static_cast<float>(count));
    for (std::size_t i = 0; i < count; ++i) {
        gaps_.emplace_back(static_cast<std::size_t>(random_.unit() * kLargestGap));
        const std::size_t next = (first + i) % count;
        contestants_[next] = make(names_[next]);
    }
    for (int frame = 0; frame < kSettlingFrames; ++frame) {
        reference_->advance(view_);
        for (const auto& contestant : contestants_) {
            contestant->advance(view_);
        }
    }
}

void EffectsWorkload::beginFrame() {
    if (frame_ > 0 && frame_ % kRoundFrames == 0) {
        beginRound();
    }
    view_ = viewOf(spheres_.bounds, frame_++);
    reference_->advance(view_);
}

double EffectsWorkload::runFrame(std::size_t contestant) {
    EffectsContestant& runner = *contestants_[contestant];
    const demos::FrameClock watch;
    runner.advance(view_);
    return watch.milliseconds();
}

void EffectsWorkload::listAnswers(std::size_t contestant, std::vector<Answer>& answers) {
    list(*contestants_[contestant], answers);
}

void EffectsWorkload::listExactAnswers(std::vector<Answer>& answers) {
    list(*reference_, answers);
    std::sort(answers.begin(), answers.end());
}

void EffectsWorkload::list(const EffectsContestant& contestant,
                           std::vector<Answer>& answers) const {
    answers.clear();
    contestant.listFinds(answers);
    Answer hash = 0;
    for (std::size_t body = 0; body < objects(); ++body) {
        for (const float coordinate : contestant.position(static_cast<std::uint32_t>(body))) {
            hash = (hash ^ std::bit_cast<std::uint32_t>(coordinate)) * 0x9e3779b97f4a7c15U;
        }
    }
    answers.push_back(hash);
}

}  // namespace hashphase::benchmarks
