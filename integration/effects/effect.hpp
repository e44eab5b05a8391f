// SPDX-License-Identifier: Zlib
#pragma once

// What a scene may call for, and sets of it.

#include <array>
#include <cstdint>
#include <initializer_list>
#include <integration/effects/export.hpp>
#include <string>
#include <string_view>

namespace hashphase {

/// The first eight change where things are; the others only look.
enum class Effect : std::uint8_t {
    motion,        ///< bodies go on with their velocities
    terrain,       ///< bodies stand on the ground
    pairs,         ///< whose boxes overlap: births and deaths
    response,      ///< bodies that touch bounce off
    sweep,         ///< fast bodies meet what they pass
    sleeping,      ///< bodies that need not move do not
    rotation,      ///< bodies turn; Bullet's alone
    friction,      ///< bodies that touch rub; Bullet's alone
    picking,       ///< what is under the pointer
    boxSelection,  ///< what is in a rectangle that is dragged
    culling,       ///< what a camera sees
    proximity,     ///< agents look at who is near
    zones,         ///< who is in which zone of interest
    radar,         ///< counts by coarse cells
};

inline constexpr std::array kAllEffects{
    Effect::motion,   Effect::terrain,   Effect::pairs,    Effect::response, Effect::sweep,
    Effect::sleeping, Effect::rotation,  Effect::friction, Effect::picking,  Effect::boxSelection,
    Effect::culling,  Effect::proximity, Effect::zones,    Effect::radar,
};

/// As it is spelled in code and in files: "boxSelection".
[[nodiscard]] HASHPHASE_EFFECTS_EXPORT std::string_view nameOf(Effect effect) noexcept;

/// A set of effects; a value of two bytes.
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

    constexpr void insert(Effect effect) noexcept { bits_ |= bitOf(effect); }
    constexpr void erase(Effect effect) noexcept {
        bits_ &= static_cast<std::uint16_t>(~bitOf(effect));
    }
    [[nodiscard]] constexpr bool contains(Effect effect) const noexcept {
        return (bits_ & bitOf(effect)) != 0;
    }
    /// Whether it has any of them.
    [[nodiscard]] constexpr bool containsAny(EffectSet others) const noexcept {
        return (bits_ & others.bits_) != 0;
    }
    [[nodiscard]] constexpr bool isEmpty() const noexcept { return bits_ == 0; }

    /// Those of either, of both, and of the first alone.
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

/// Their names with commas between them; "nothing" for none.
[[nodiscard]] HASHPHASE_EFFECTS_EXPORT std::string namesOf(EffectSet effects);

/// Those that decide where the bodies of a Simulation are.
inline constexpr EffectSet kMovingEffects{Effect::motion, Effect::terrain, Effect::response,
                                          Effect::sweep, Effect::sleeping};

}  // namespace hashphase
