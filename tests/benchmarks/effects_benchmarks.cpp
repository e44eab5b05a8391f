// SPDX-License-Identifier: Zlib

// What does it cost to declare a scene's effects, in place of writing its frame by hand? Everybody runs
// the same frames, each with bodies of its own.
//
// Rounds    Where tables happen to lie in memory makes differences of some per cent, which last as
//           long as the tables. So everybody is made anew, elsewhere and of other spheres, after
//           every twenty frames.
// Timed     the whole frame: bodies move, the grid has them, the scene's own effect is run.
// Answers   are what the scene's own effect says, in numbers that tell its pairs, visible bodies or
//           colours, and a hash of where all bodies are: to the last bit as by hand.

#include <demos/compare/reference_pairs.hpp>
#include <demos/scenes/random.hpp>
#include <integration/effects/simulation.hpp>
#include <tests/benchmarks/effects.hpp>
#include <tests/support/camera_matrices.hpp>

#include <algorithm>
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
class Simulated final : public EffectsBody {
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

void list(const EffectsBody& body, std::size_t count, std::vector<Answer>& answers) {
    answers.clear();
    body.listFinds(answers);
    Answer hash = 0;
    for (std::size_t i = 0; i < count; ++i) {
        for (const float coordinate : body.position(static_cast<std::uint32_t>(i))) {
            hash = (hash ^ std::bit_cast<std::uint32_t>(coordinate)) * 0x9e3779b97f4a7c15U;
        }
    }
    answers.push_back(hash);
}

class EffectsWorkload final : public Workload {
public:
    EffectsWorkload(EffectSet own, std::size_t objects, std::uint64_t seed)
        : own_(own),
          seed_(seed),
          spheres_(objects, seed),
          view_(viewOf(spheres_.bounds, 0)),
          reference_(makeByHand(own, spheres_)),
          random_(seed) {}

    [[nodiscard]] std::unique_ptr<Runner> make(const ContestantKind& kind) override {
        auto runner = std::make_unique<Advancing>(*this, kind.name);
        runners_.push_back(runner.get());
        return runner;
    }

    void beginFrame() override {
        if (frame_ > 0 && frame_ % kRoundFrames == 0) {
            beginRound();
        }
        view_ = viewOf(spheres_.bounds, frame_++);
        reference_->advance(view_);
    }

    void listExactAnswers(std::vector<Answer>& answers) override {
        list(*reference_, objects(), answers);
        std::sort(answers.begin(), answers.end());
    }

    [[nodiscard]] std::size_t objects() const override { return spheres_.positions.size(); }

private:
    struct Advancing final : Runner {
        Advancing(const EffectsWorkload& itsWorkload, std::string itsName)
            : workload(itsWorkload), name(std::move(itsName)) {
            makeBody();
        }

        void makeBody() {
            const EffectSet own = workload.own_;
            body = name.starts_with("by-hand")
                       ? makeByHand(own, workload.spheres_)
                       : std::make_unique<Simulated>(own, name == "declared" ? own : kSimulated,
                                                     workload.spheres_);
        }
        void run() override { body->advance(workload.view_); }
        void listAnswers(std::vector<Answer>& answers) override {
            list(*body, workload.objects(), answers);
        }

        const EffectsWorkload& workload;
        std::string name;
        std::unique_ptr<EffectsBody> body;
    };

    void beginRound() {
        for (Advancing* runner : runners_) {
            runner->body.reset();
        }
        gaps_.clear();
        spheres_ = RoamingSpheres(objects(), ++seed_);
        reference_ = makeByHand(own_, spheres_);
        const std::size_t count = runners_.size();
        const auto first = static_cast<std::size_t>(random_.unit() * static_cast<float>(count));
        for (std::size_t i = 0; i < count; ++i) {
            gaps_.emplace_back(static_cast<std::size_t>(random_.unit() * kLargestGap));
            runners_[(first + i) % count]->makeBody();
        }
        for (int frame = 0; frame < kSettlingFrames; ++frame) {
            reference_->advance(view_);
            for (Advancing* runner : runners_) {
                runner->run();
            }
        }
    }

    EffectSet own_;
    std::uint64_t seed_;
    RoamingSpheres spheres_;
    int frame_ = 0;
    ConvexRegion<float> view_;
    std::unique_ptr<EffectsBody> reference_;  // by hand, untimed
    std::vector<Advancing*> runners_;
    demos::Random random_;
    std::vector<std::vector<char>> gaps_;  // between what the contestants hold
};

Benchmark effectsBenchmark(const char* name, const char* description, EffectSet own) {
    return {
        .name = name,
        .group = "effects",
        .description = description,
        .sizes = {30'000},
        .frames = 1000,  // a median of the ratios of so many is known to some thousandths
        .onRequest = true,
        .contestants =
            [](std::size_t, std::uint64_t) {
                return std::vector<ContestantKind>{
                    {.name = "by-hand", .title = "Grid and Pairs, Culler or RarestColour"},
                    // The scene's own effects are declared; all are, and bodies take part in those.
                    {.name = "declared", .title = "Simulation", .ours = true},
                    {.name = "nobody", .title = "Simulation", .ours = true},
                    // What differs by chance.
                    {.name = "by-hand-again", .title = "as by-hand"}};
            },
        .make =
            [own](std::size_t objects, std::uint64_t seed) {
                return std::make_unique<EffectsWorkload>(own, objects, seed);
            }};
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

std::vector<Benchmark> effectsBenchmarks() {
    return {effectsBenchmark("effects-pairs", "roaming spheres and their overlapping boxes",
                             {Effect::motion, Effect::pairs}),
            effectsBenchmark("effects-response", "roaming spheres that bounce off each other",
                             {Effect::motion, Effect::pairs, Effect::response}),
            effectsBenchmark("effects-culling", "roaming spheres, of which a camera sees a tenth",
                             {Effect::motion, Effect::culling}),
            effectsBenchmark("effects-proximity", "roaming agents that take the rarest colour",
                             {Effect::motion, Effect::proximity})};
}

}  // namespace hashphase::benchmarks
