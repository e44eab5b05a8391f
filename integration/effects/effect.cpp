// SPDX-License-Identifier: Zlib
#include <integration/effects/effect.hpp>

#include <broadphase/core/raise.inl>
#include <integration/effects/undeclared_effect.hpp>

#include <algorithm>
#include <cstddef>

namespace hashphase {

std::string_view nameOf(Effect effect) noexcept {
    // In the order of Effect.
    static constexpr std::array<std::string_view, kAllEffects.size()> kNames{
        "motion",   "terrain", "pairs",        "response", "sweep",     "sleeping", "rotation",
        "friction", "picking", "boxSelection", "culling",  "proximity", "zones",    "radar"};
    const auto i = static_cast<std::size_t>(effect);
    return i < kNames.size() ? kNames[i] : std::string_view();
}

std::string namesOf(EffectSet effects) {
    std::string names;
    for (const Effect effect : kAllEffects) {
        if (effects.contains(effect)) {
            names += names.empty() ? "" : ", ";
            names += nameOf(effect);
        }
    }
    return names.empty() ? "nothing" : names;
}

UndeclaredEffect::UndeclaredEffect(Effect effect, std::string_view call)
    : std::logic_error(std::string(call) + " needs " + std::string(nameOf(effect)) +
                       ", which the scene does not declare. Set SceneEffects::" +
                       std::string(nameOf(effect)) + '.'),
      effect_(effect) {}

UndeclaredEffect::UndeclaredEffect(EffectSet oneOf, std::string_view call)
    : std::logic_error(
          std::string(call) +
          " needs one of these effects, but the scene declares none. Set one in SceneEffects: " +
          namesOf(oneOf) + '.'),
      effect_(*std::find_if(kAllEffects.begin(), kAllEffects.end(),
                            [oneOf](Effect effect) { return oneOf.contains(effect); })) {}

namespace detail {

void raiseUndeclared(Effect effect, std::string_view call) {
    raise(UndeclaredEffect(effect, call));
}

void raiseUndeclared(EffectSet oneOf, std::string_view call) {
    raise(UndeclaredEffect(oneOf, call));
}

}  // namespace detail

}  // namespace hashphase
