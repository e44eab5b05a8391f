// SPDX-License-Identifier: Zlib
#pragma once

// The exception for calls that need an effect which the scene does not declare.

#include <integration/effects/effect.hpp>
#include <integration/effects/export.hpp>

#include <stdexcept>
#include <string_view>

namespace hashphase {

/// Thrown by a call that needs an undeclared effect. The call has changed nothing. what() names the call and the
/// effect.
class HASHPHASE_EFFECTS_EXPORT UndeclaredEffect : public std::logic_error {
public:
    /// `call` names the called function, such as "colours()".
    UndeclaredEffect(Effect effect, std::string_view call);

    /// For a call that needs one of the effects in `oneOf` (not empty). effect() returns the one that comes first
    /// in the enum Effect.
    UndeclaredEffect(EffectSet oneOf, std::string_view call);

    /// The effect to declare.
    [[nodiscard]] Effect effect() const noexcept { return effect_; }

private:
    Effect effect_;
};

namespace detail {

/// Throws UndeclaredEffect(effect, call).
[[noreturn]] void raiseUndeclared(Effect effect, std::string_view call);
/// Throws UndeclaredEffect(oneOf, call).
[[noreturn]] void raiseUndeclared(EffectSet oneOf, std::string_view call);

}  // namespace detail

}  // namespace hashphase
