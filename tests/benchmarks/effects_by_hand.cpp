// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/effects.hpp>

#include <broadphase/pairs.hpp>
#include <demos/compare/reference_pairs.hpp>
#include <integration/ai/rarest_colour.hpp>
#include <integration/culling/culler.hpp>

#include <algorithm>
#include <cmath>
#include <span>

namespace hashphase::benchmarks {
namespace {

/// Motion, which all scenes have.
class HandMoved : public EffectsBody {
public:
    explicit HandMoved(const RoamingSpheres& spheres)
        : bounds_(spheres.bounds),
          positions_(spheres.positions),
          velocities_(spheres.velocities),
          radii_(spheres.radii) {}

    [[nodiscard]] Vector3<float> position(std::uint32_t body) const override {
        return positions_[body];
    }

protected:
    static Aabb<float> boxAt(const Vector3<float>& center, float radius) {
        const auto half = Vector3<float>::Constant(radius);
        return {center - half, center + half};
    }

    void addAll() {
        for (std::size_t i = 0; i < positions_.size(); ++i) {
            ids_.push_back(grid_.add(boxAt(positions_[i], radii_[i])));
        }
    }

    void moveAll() {
        const Vector3<float> low = bounds_.min();
        const Vector3<float> high = bounds_.max();
        const std::span<Vector3<float>> positions = positions_;
        const std::span<Vector3<float>> velocities = velocities_;
        const std::span<const float> radii = radii_;
        const std::span<const ProxyId> ids = ids_;
        for (std::size_t i = 0; i < positions.size(); ++i) {
            Vector3<float>& velocity = velocities[i];
            Vector3<float> position = positions[i] + velocity * RoamingSpheres::kTimeStep;
            for (int axis = 0; axis < 3; ++axis) {
                if (position[axis] < low[axis]) {
                    position[axis] = low[axis];
                    velocity[axis] = std::abs(velocity[axis]);
                } else if (position[axis] > high[axis]) {
                    position[axis] = high[axis];
                    velocity[axis] = -std::abs(velocity[axis]);
                }
            }
            positions[i] = position;
            grid_.move(ids[i], boxAt(position, radii[i]));
        }
    }

    Aabb<float> bounds_;
    std::vector<Vector3<float>> positions_;
    std::vector<Vector3<float>> velocities_;
    std::vector<float> radii_;
    Grid<float> grid_;
    std::vector<ProxyId> ids_;
};

class HandPaired : public HandMoved {
public:
    explicit HandPaired(const RoamingSpheres& spheres) : HandMoved(spheres), pairs_(grid_) {
        addAll();
    }

    void advance(const ConvexRegion<float>& /*view*/) override {
        moveAll();
        changes_ =
            pairs_.update([](std::span<const ProxyPair> /*asked*/, std::span<char> accepted) {
                std::fill(accepted.begin(), accepted.end(), char{1});
            });
    }

    void listFinds(std::vector<Answer>& finds) const override { listChanges(changes_, finds); }

protected:
    Pairs<float> pairs_;
    PairChanges changes_;
};

/// Spheres of the same mass that lose nothing when they meet.
class HandBounced final : public HandPaired {
public:
    using HandPaired::HandPaired;

    void advance(const ConvexRegion<float>& view) override {
        HandPaired::advance(view);
        gather();
        for (const SpherePair& pair : present_) {
            bounce(pair);
        }
    }

private:
    struct SpherePair {
        std::uint32_t a;
        std::uint32_t b;

        friend constexpr auto operator<=>(const SpherePair&, const SpherePair&) = default;
    };

    static SpherePair spherePairOf(const ProxyPair& pair) {
        return {pair.first.index, pair.second.index};
    }

    // Merges the present pairs with those born, and leaves out those that died.
    void gather() {
        const auto [allBorn, allDied] = changes_;
        auto born = allBorn.begin();
        auto died = allDied.begin();
        next_.clear();
        for (const SpherePair& pair : present_) {
            if (died != allDied.end() && spherePairOf(*died) == pair) {
                ++died;
                continue;
            }
            for (; born != allBorn.end() && spherePairOf(*born) < pair; ++born) {
                next_.push_back(spherePairOf(*born));
            }
            next_.push_back(pair);
        }
        for (; born != allBorn.end(); ++born) {
            next_.push_back(spherePairOf(*born));
        }
        present_.swap(next_);
    }

    void bounce(const SpherePair& pair) {
        const float reach = radii_[pair.a] + radii_[pair.b];
        const Vector3<float> apart = positions_[pair.b] - positions_[pair.a];
        if (apart.squaredNorm() > reach * reach) {
            return;
        }
        const float distance = apart.norm();
        const Vector3<float> normal =
            distance > 0 ? Vector3<float>(apart / distance) : Vector3<float>::UnitX();
        Vector3<float>& velocityA = velocities_[pair.a];
        Vector3<float>& velocityB = velocities_[pair.b];
        const float approach = velocityA.dot(normal) - velocityB.dot(normal);
        if (approach > 0) {
            const Vector3<float> change = normal * approach;
            velocityA -= change;
            velocityB += change;
        }
    }

    std::vector<SpherePair> present_;  // sorted
    std::vector<SpherePair> next_;
};

class HandCulled final : public HandMoved {
public:
    explicit HandCulled(const RoamingSpheres& spheres) : HandMoved(spheres) { addAll(); }

    void advance(const ConvexRegion<float>& view) override {
        moveAll();
        grid_.update();
        culler_.look(grid_, view);
    }

    void listFinds(std::vector<Answer>& finds) const override {
        culler_.forEach([&](std::uint32_t body) { finds.push_back(body); });
    }

private:
    Culler<float> culler_;
};

class HandColoured final : public HandMoved {
public:
    explicit HandColoured(const RoamingSpheres& spheres)
        : HandMoved(spheres), colours_(spheres.colours) {
        addAll();
    }

    void advance(const ConvexRegion<float>& /*view*/) override {
        moveAll();
        grid_.update();
        rarest_.update(grid_, RoamingSpheres::kSight, RoamingSpheres::kColours, colours_);
    }

    void listFinds(std::vector<Answer>& finds) const override { listColours(colours_, finds); }

private:
    RarestColour<float> rarest_;
    std::vector<std::uint32_t> colours_;
};

}  // namespace

std::unique_ptr<EffectsBody> makeByHand(EffectSet own, const RoamingSpheres& spheres) {
    if (own.contains(Effect::response)) {
        return std::make_unique<HandBounced>(spheres);
    }
    if (own.contains(Effect::pairs)) {
        return std::make_unique<HandPaired>(spheres);
    }
    if (own.contains(Effect::culling)) {
        return std::make_unique<HandCulled>(spheres);
    }
    return std::make_unique<HandColoured>(spheres);
}

}  // namespace hashphase::benchmarks
