// SPDX-License-Identifier: Zlib
#pragma once

// The effects that a scene can declare, and sets of effects.

#include <array>
#include <cstdint>
#include <initializer_list>
#include <integration/effects/export.hpp>
#include <string>
#include <string_view>

namespace hashphase {

/// An effect that a scene can declare. The first eight effects are physics. The other six only query the scene.
enum class Effect : std::uint8_t {
    motion,        ///< bodies move with their velocities
    terrain,       ///< bodies stand on the ground
    pairs,         ///< reports births and deaths of overlapping pairs
    response,      ///< touching bodies bounce
    sweep,         ///< fast bodies hit bodies on their paths
    sleeping,      ///< slow bodies, and bodies far from the player, stand still
    rotation,      ///< bodies rotate; only in Bullet
    friction,      ///< friction between touching bodies; only in Bullet
    picking,       ///< finds bodies under the pointer
    boxSelection,  ///< finds bodies in a dragged rectangle
    culling,       ///< finds bodies that a camera sees
    proximity,     ///< agents (proxies) take the colour (a number) that is rarest around them
    zones,         ///< finds proxies in zones
    radar,         ///< counts proxies in coarse cells
};

/// Every effect, in the order of Effect.
inline constexpr std::array kAllEffects{
    Effect::motion,   Effect::terrain,   Effect::pairs,    Effect::response, Effect::sweep,
    Effect::sleeping, Effect::rotation,  Effect::friction, Effect::picking,  Effect::boxSelection,
    Effect::culling,  Effect::proximity, Effect::zones,    Effect::radar,
};

/// Returns the enumerator's name, such as "boxSelection"; empty for other values.
[[nodiscard]] HASHPHASE_EFFECTS_EXPORT std::string_view nameOf(Effect effect) noexcept;

/// A set of effects: a value of two bytes, empty by default. Each operation costs O(1).
class EffectSet {
public:
    constexpr EffectSet() noexcept = default;
    constexpr EffectSet(std::initializer_list<Effect> effects) noexcept {
        for (const Effect effect : effects) {
            insert(effect);
        }
    }
    [[nodiscard]] static constexpr EffectSet all() noexcept {
        EffectSet set;
        for (const Effect effect : kAllEffects) {
            set.insert(effect);
        }
        return set;
    }

    /// insert() changes nothing if the effect is in the set. erase() changes nothing if the effect is not in the set.
    constexpr void insert(Effect effect) noexcept { bits_ |= bitOf(effect); }
    constexpr void erase(Effect effect) noexcept {
        bits_ &= static_cast<std::uint16_t>(~bitOf(effect));
    }
    [[nodiscard]] constexpr bool contains(Effect effect) const noexcept {
        return (bits_ & bitOf(effect)) != 0;
    }
    /// Returns whether the two sets have any effect in common.
    [[nodiscard]] constexpr bool containsAny(EffectSet others) const noexcept {
        return (bits_ & others.bits_) != 0;
    }
    [[nodiscard]] constexpr bool isEmpty() const noexcept { return bits_ == 0; }

    /// Union (|), intersection (&) and difference (-).
    friend constexpr EffectSet operator|(EffectSet a, EffectSet b) noexcept {
        return EffectSet(static_cast<std::uint16_t>(a.bits_ | b.bits_));
    }
    friend constexpr EffectSet operator&(EffectSet a, EffectSet b) noexcept {
        return EffectSet(static_cast<std::uint16_t>(a.bits_ & b.bits_));
    }
    friend constexpr EffectSet operator-(EffectSet a, EffectSet b) noexcept {
        return EffectSet(static_cast<std::uint16_t>(a.bits_ & ~b.bits_));
    }
    friend constexpr bool operator==(EffectSet, EffectSet) noexcept = default;

private:
    explicit constexpr EffectSet(std::uint16_t bits) noexcept : bits_(bits) {}
    [[nodiscard]] static constexpr std::uint16_t bitOf(Effect effect) noexcept {
        return static_cast<std::uint16_t>(1U << static_cast<unsigned>(effect));
    }

    std::uint16_t bits_ = 0;
};

/// Returns the names in the order of Effect, such as "motion, pairs"; "nothing" for an empty set.
[[nodiscard]] HASHPHASE_EFFECTS_EXPORT std::string namesOf(EffectSet effects);

/// The effects that decide the positions of a Simulation's bodies.
inline constexpr EffectSet kMovingEffects{Effect::motion, Effect::terrain, Effect::response,
                                          Effect::sweep, Effect::sleeping};

}  // namespace hashphase
