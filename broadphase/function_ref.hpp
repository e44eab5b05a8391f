// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/export.hpp>

#include <memory>
#include <type_traits>
#include <utility>

// Before a parameter that what is made of it refers to: Clang warns where it is a temporary that is gone
// before that.
#if __has_cpp_attribute(clang::lifetimebound)
#define HASHPHASE_LIFETIME_BOUND [[clang::lifetimebound]]
#else
#define HASHPHASE_LIFETIME_BOUND
#endif

namespace hashphase {

template <class Signature>
class FunctionRef;

/// A reference to anything callable, for parameters only: it must not outlive the call that it is
/// passed to, nor the callable. To keep a lambda, keep it as `const auto`. Two pointers, no allocation.
template <class Result, class... Arguments>
class FunctionRef<Result(Arguments...)> {
public:
    template <class Callable>
        requires(!std::is_same_v<std::remove_cvref_t<Callable>, FunctionRef> &&
                 std::is_invocable_r_v<Result, Callable&, Arguments...>)
    // NOLINTNEXTLINE(bugprone-forwarding-reference-overload): copies are ruled out above
    FunctionRef(Callable&& callable HASHPHASE_LIFETIME_BOUND)
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
