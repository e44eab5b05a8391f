// SPDX-License-Identifier: Zlib
#include <integration/effects/effect.hpp>

#include <integration/effects/undeclared_effect.hpp>

#include <algorithm>

namespace hashphase {

std::string_view nameOf(Effect effect) noexcept {
    switch (effect) {
        case Effect::motion:
            return "motion";
        case Effect::terrain:
            return "terrain";
        case Effect::pairs:
            return "pairs";
        case Effect::response:
            return "response";
        case Effect::sweep:
            return "sweep";
        case Effect::sleeping:
            return "sleeping";
        case Effect::rotation:
            return "rotation";
        case Effect::friction:
            return "friction";
        case Effect::picking:
            return "picking";
        case Effect::boxSelection:
            return "boxSelection";
        case Effect::culling:
            return "culling";
        case Effect::proximity:
            return "proximity";
        case Effect::zones:
            return "zones";
        case Effect::radar:
            return "radar";
    }
    return {};
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
                       ", which the scene does not declare: set SceneEffects::" +
                       std::string(nameOf(effect)) + '.'),
      effect_(effect) {}

UndeclaredEffect::UndeclaredEffect(EffectSet oneOf, std::string_view call)
    : std::logic_error(std::string(call) +
                       " needs one of these, of which the scene declares none: " + namesOf(oneOf) +
                       '.'),
      effect_(*std::find_if(kAllEffects.begin(), kAllEffects.end(),
                            [oneOf](Effect effect) { return oneOf.contains(effect); })) {}

}  // namespace hashphase
