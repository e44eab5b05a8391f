// SPDX-License-Identifier: Zlib
#pragma once

// What does it cost to declare a scene's effects, in place of writing its frame by hand? Spheres
// roam a square; everybody runs the same frames, each with bodies of its own.
//
// Rounds    Where tables happen to lie in memory makes differences of some per cent, which last as
//           long as the tables. So everybody is made anew, elsewhere and of other spheres, after
//           every twenty frames.
// Timed     the whole frame: bodies move, the grid has them, the scene's own effect is run.
// Answers   are what the scene's own effect says, in numbers that tell its pairs, visible bodies or
//           colours, and a hash of where all bodies are: to the last bit as by hand.

#include <demos/scenes/random.hpp>
#include <tests/benchmarks/workload.hpp>

#include <broadphase/convex_region.hpp>
#include <broadphase/pairs.hpp>
#include <integration/effects/effect.hpp>

#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace hashphase::benchmarks {

inline constexpr std::string_view kEffectsGroup = "effects";

/// The contestants: by hand without hashphase::effects, twice; with just the scene's own effects
/// declared; and with all of them declared, though bodies take part in the scene's own alone.
inline constexpr std::string_view kByHand = "by-hand";
inline constexpr std::string_view kByHandAgain = "by-hand-again";
inline constexpr std::string_view kDeclared = "declared";
inline constexpr std::string_view kNobody = "nobody";

[[nodiscard]] std::vector<ContestantKind> effectsKinds();

/// Spheres as dense as the paper's.
struct RoamingSpheres {
    RoamingSpheres(std::size_t count, std::uint64_t seed);

    static constexpr float kRadius = 1;            // on the mean; by up to a tenth more or less [m]
    static constexpr float kTimeStep = 1.0F / 60;  // [s]
    static constexpr float kSight = 10;            // how far colours are seen [m]
    static constexpr std::uint32_t kColours = 4;

    Aabb<float> bounds;  // of their centres, where they turn back
    std::vector<Vector3<float>> positions;
    std::vector<Vector3<float>> velocities;
    std::vector<float> radii;
    std::vector<std::uint32_t> colours;
};

/// Who runs the frames of a scene.
class EffectsContestant {
public:
    EffectsContestant() = default;
    EffectsContestant(const EffectsContestant&) = delete;
    EffectsContestant& operator=(const EffectsContestant&) = delete;
    virtual ~EffectsContestant() = default;

    /// A frame; `view` is what the camera sees in it.
    virtual void advance(const ConvexRegion<float>& view) = 0;

    [[nodiscard]] virtual Vector3<float> position(std::uint32_t body) const = 0;

    /// Appends what the scene's own effect said in the last frame.
    virtual void listFinds(std::vector<Answer>& finds) const = 0;
};

/// Finds as answers: births and deaths of pairs, and each body's colour.
void listChanges(const PairChanges& changes, std::vector<Answer>& finds);
void listColours(std::span<const std::uint32_t> colours, std::vector<Answer>& finds);

/// Of scenes with motion and one of pairs, pairs and response, culling, or proximity.
class EffectsWorkload : public Workload {
public:
    EffectsWorkload(EffectSet own, std::size_t objects, std::uint64_t seed);

    void add(const ContestantKind& kind) override;
    void beginFrame() override;
    double runFrame(std::size_t contestant) override;
    void listAnswers(std::size_t contestant, std::vector<Answer>& answers) override;
    void listExactAnswers(std::vector<Answer>& answers) override;
    [[nodiscard]] std::size_t objects() const override { return spheres_.positions.size(); }
    [[nodiscard]] std::size_t operations() const override { return objects(); }

private:
    [[nodiscard]] std::unique_ptr<EffectsContestant> make(std::string_view name);
    void beginRound();
    void list(const EffectsContestant& contestant, std::vector<Answer>& answers) const;

    EffectSet own_;
    std::uint64_t seed_;
    RoamingSpheres spheres_;
    int frame_ = 0;
    ConvexRegion<float> view_;
    std::unique_ptr<EffectsContestant> reference_;  // by hand, untimed
    std::vector<std::string> names_;
    std::vector<std::unique_ptr<EffectsContestant>> contestants_;
    demos::Random random_;
    std::vector<std::vector<char>> gaps_;  // between what the contestants hold
};

}  // namespace hashphase::benchmarks
