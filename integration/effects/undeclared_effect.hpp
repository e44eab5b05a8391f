// SPDX-License-Identifier: Zlib
#pragma once

#include <integration/effects/effect.hpp>
#include <integration/effects/export.hpp>

#include <stdexcept>
#include <string_view>

namespace hashphase {

/// Thrown by a call for an effect that the scene does not declare. It has done nothing.
class HASHPHASE_EFFECTS_EXPORT UndeclaredEffect : public std::logic_error {
public:
    /// `call` is what was asked for: "colours()".
    UndeclaredEffect(Effect effect, std::string_view call);

    /// Of a call that any one of these would do for; effect() is the first of them.
    UndeclaredEffect(EffectSet oneOf, std::string_view call);

    [[nodiscard]] Effect effect() const noexcept { return effect_; }

private:
    Effect effect_;
};

}  // namespace hashphase
