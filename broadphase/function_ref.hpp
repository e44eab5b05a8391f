// SPDX-License-Identifier: Zlib
#pragma once

#include <memory>
#include <type_traits>
#include <utility>

namespace hashphase {

template <class Signature>
class FunctionRef;

/// A reference to anything callable, for parameters only: it must not outlive the call that it is
/// passed to. Two pointers, no allocation.
template <class Result, class... Arguments>
class FunctionRef<Result(Arguments...)> {
public:
    template <class Callable>
        requires(!std::is_same_v<std::remove_cvref_t<Callable>, FunctionRef> &&
                 std::is_invocable_r_v<Result, Callable&, Arguments...>)
    // NOLINTNEXTLINE(bugprone-forwarding-reference-overload): copies are ruled out above
    FunctionRef(Callable&& callable)
    noexcept {
        using Target = std::remove_reference_t<Callable>;
        if constexpr (std::is_function_v<Target>) {
            object_ = reinterpret_cast<void*>(&callable);
            invoke_ = [](void* object, Arguments... arguments) -> Result {
                return reinterpret_cast<Target*>(object)(std::forward<Arguments>(arguments)...);
            };
        } else {
            object_ = const_cast<void*>(static_cast<const void*>(std::addressof(callable)));
            invoke_ = [](void* object, Arguments... arguments) -> Result {
                return (*static_cast<Target*>(object))(std::forward<Arguments>(arguments)...);
            };
        }
    }

    Result operator()(Arguments... arguments) const {
        return invoke_(object_, std::forward<Arguments>(arguments)...);
    }

private:
    void* object_;
    Result (*invoke_)(void*, Arguments...);
};

}  // namespace hashphase
