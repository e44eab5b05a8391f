// SPDX-License-Identifier: Zlib
#pragma once

// A random life for the boxes of a scene: they are created, drift, jump, rest for long, wake, go
// bad, heal, change colour and are destroyed.

#include <tests/support/box_scenes.hpp>
#include <tests/support/oracles.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace hashphase::test {

/// How often things happen in a frame: shares of the proxies that are awake, but for the last.
struct ScriptRates {
    double nudge = 0.5;
    double jump = 0.03;
    double fallAsleep = 0.06;
    double goBad = 0.01;
    double recolour = 0.0;
    double replace = 0.02;  // of all proxies: one is destroyed, one created
};

/// Plays on any World with
///   ProxyId add(const Aabb<Scalar>&, Mobility);
///   void move(ProxyId, const Aabb<Scalar>&);
///   void remove(ProxyId);
///   void refilter(ProxyId);   the colour has changed; or
///   void paint(ProxyId, std::uint32_t colour);   that is its colour now, or as it was created
/// All proxies rest at the end of every period of kPeriod frames, so long that whatever waits for
/// them to be quiet will happen.
template <class Scalar>
class Script {
public:
    static constexpr std::uint32_t kPeriod = 48;
    static constexpr std::uint32_t kQuietFrom = 28;

    Script(const BoxScene<Scalar>& scene, std::uint64_t seed, const ScriptRates& rates = {})
        : scene_(scene), random_(seed), rates_(rates) {}

    /// Creates the scene's proxies.
    template <class World>
    void begin(World& world) {
        for (std::uint32_t i = 0; i < scene_.count; ++i) {
            create(world);
        }
    }

    template <class World>
    void playFrame(World& world) {
        const std::uint32_t phase = ++frame_ % kPeriod;
        const bool allRest = phase >= kQuietFrom;
        // While all others rest, a few may still disturb them.
        const double share = !allRest ? 1 : phase % 8 == 7 ? 0.02 : 0;
        recolourSome(world, share);
        for (std::size_t i = 0; i < proxies_.size(); ++i) {
            if (plans_[i].moves && plans_[i].asleepUntil <= frame_ && random_.chance(share)) {
                act(world, i);
            }
        }
        if (share > 0) {
            replaceSome(world);
        }
        recolourSome(world, share);
    }

    /// To be called before the shift of a world's origin. What is created later, or jumps, is drawn
    /// where the scene has always been.
    void shiftOrigin(const Vector3<Scalar>& shift) {
        const auto by = [&shift](Aabb<Scalar>& box) {
            box = {box.min() - shift, box.max() - shift};
        };
        for (std::size_t i = 0; i < proxies_.size(); ++i) {
            by(proxies_[i].box);
            by(plans_[i].healthy);
        }
    }

    [[nodiscard]] std::span<const Placed<Scalar>> proxies() const noexcept { return proxies_; }

    /// The filter that the colours make.
    [[nodiscard]] bool accepts(ProxyId a, ProxyId b) const { return colours_.accept(a, b); }

    [[nodiscard]] Random& random() noexcept { return random_; }

private:
    struct Plan {
        std::uint32_t asleepUntil = 0;  // frame
        bool moves = true;
        bool isBad = false;
        Aabb<Scalar> healthy{};
    };

    template <class World>
    void create(World& world) {
        Placed<Scalar> proxy;
        proxy.box = scene_.draw(random_);
        proxy.colour = rates_.recolour > 0 && random_.chance(0.5) ? 1 + random_.below(2) : 0;
        Plan plan;
        plan.moves = random_.chance(scene_.mobileShare);
        proxy.id = world.add(proxy.box, plan.moves ? Mobility::mobile : Mobility::resting);
        proxies_.push_back(proxy);
        plans_.push_back(plan);
        colours_.set(proxy.id, proxy.colour);
        if constexpr (requires { world.paint(proxy.id, proxy.colour); }) {
            world.paint(proxy.id, proxy.colour);
        }
    }

    template <class World>
    void act(World& world, std::size_t i) {
        Plan& plan = plans_[i];
        const Aabb<Scalar> present = proxies_[i].box;
        if (plan.isBad) {
            plan.isBad = false;
            set(world, i, plan.healthy);
        } else if (random_.chance(rates_.goBad)) {
            plan.isBad = true;
            plan.healthy = present;
            plan.asleepUntil = frame_ + random_.below(12);
            set(world, i, hostileBox<Scalar>(random_));
        } else if (random_.chance(rates_.jump)) {
            set(world, i, scene_.draw(random_));
        } else if (random_.chance(rates_.fallAsleep)) {
            plan.asleepUntil = frame_ + random_.below(30);
            set(world, i, present);
        } else if (random_.chance(rates_.nudge)) {
            set(world, i, scene_.nudge(random_, present));
        }
    }

    template <class World>
    void set(World& world, std::size_t i, const Aabb<Scalar>& box) {
        proxies_[i].box = box;
        world.move(proxies_[i].id, box);
    }

    template <class World>
    void replaceSome(World& world) {
        const double expected = rates_.replace * static_cast<double>(scene_.count);
        const auto count = static_cast<std::uint32_t>(random_.between(0, 2 * expected));
        for (std::uint32_t i = 0; i < count; ++i) {
            if (random_.chance(0.5) && !proxies_.empty()) {
                const std::uint32_t victim =
                    random_.below(static_cast<std::uint32_t>(proxies_.size()));
                world.remove(proxies_[victim].id);
                proxies_[victim] = proxies_.back();
                proxies_.pop_back();
                plans_[victim] = plans_.back();
                plans_.pop_back();
            } else if (proxies_.size() < 2 * scene_.count) {
                create(world);
            }
        }
    }

    template <class World>
    void recolourSome(World& world, double share) {
        for (Placed<Scalar>& proxy : proxies_) {
            if (rates_.recolour > 0 && random_.chance(rates_.recolour * share)) {
                proxy.colour = random_.below(3);
                colours_.set(proxy.id, proxy.colour);
                if constexpr (requires { world.paint(proxy.id, proxy.colour); }) {
                    world.paint(proxy.id, proxy.colour);
                } else {
                    world.refilter(proxy.id);
                }
            }
        }
    }

    BoxScene<Scalar> scene_;
    Random random_;
    ScriptRates rates_;
    std::uint32_t frame_ = 0;
    std::vector<Placed<Scalar>> proxies_;
    std::vector<Plan> plans_;  // beside proxies_
    Colours colours_;
};

}  // namespace hashphase::test
