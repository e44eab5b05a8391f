// SPDX-License-Identifier: Zlib
#pragma once

// A setting of somebody else's that is overridden for a while, and then given back.

#include <integration/bullet/precision.hpp>

#include <LinearMath/btScalar.h>

#include <optional>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {

/// Remembers what a setting was before it was overridden. Who sets it meanwhile is believed: that is
/// from then on what the setting was.
template <class Value>
class KeptSetting {
public:
    /// What to write where `present` is found: the wanted value, or without one what it was before.
    [[nodiscard]] Value next(const Value& present, const std::optional<Value>& wanted) {
        if (!isHeld_ || !(present == written_)) {
            own_ = present;
        }
        isHeld_ = wanted.has_value();
        written_ = wanted.value_or(own_);
        return written_;
    }

    /// Whether it is overridden, and `present` is what was written.
    [[nodiscard]] bool isAsWritten(const Value& present) const {
        return isHeld_ && present == written_;
    }

    /// Whether the setting is overridden.
    [[nodiscard]] bool isHeld() const noexcept { return isHeld_; }

private:
    Value own_{};
    Value written_{};
    bool isHeld_ = false;
};

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
