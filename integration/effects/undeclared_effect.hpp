// SPDX-License-Identifier: Zlib
#pragma once

#include <integration/effects/effect.hpp>
#include <integration/effects/export.hpp>

#include <stdexcept>
#include <string_view>

namespace hashphase {

/// Thrown by a call for an effect that the scene does not declare; the call has done nothing. what() names
/// the call and the effect.
class HASHPHASE_EFFECTS_EXPORT UndeclaredEffect : public std::logic_error {
public:
    /// `call` is the function that was called: "colours()".
    UndeclaredEffect(Effect effect, std::string_view call);

    /// For a call that needs any one of these effects; effect() is the first of them. `oneOf` is not empty.
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
