// SPDX-License-Identifier: Zlib
#pragma once

// A reference to a function, as parameters of this library take it: cheaper than std::function, which owns
// a copy.
//
//     void visitAll(FunctionRef<void(ProxyId)> visit);
//     visitAll([&](ProxyId id) { ... });                     // right: the lambda lives until the call ends
//     FunctionRef<void(ProxyId)> visit = [&](ProxyId) { };   // wrong: the lambda is gone after this line

#include <broadphase/core/compiler.hpp>
#include <broadphase/export.hpp>

#include <memory>
#include <type_traits>
#include <utility>

namespace hashphase {

template <class Signature>
class FunctionRef;

/// A reference to anything callable: a lambda, a function, a function object. For parameters only: it must
/// outlive neither the call to which it is passed nor the callable. To keep a lambda, keep it as
/// `const auto`. Size: two pointers. Allocates nothing. Never empty.
template <class Result, class... Arguments>
class FunctionRef<Result(Arguments...)> {
public:
    /// Refers to `callable`, which takes these arguments and returns a Result or what converts to it.
    template <class Callable>
        requires(!std::is_same_v<std::remove_cvref_t<Callable>, FunctionRef> &&
                 std::is_invocable_r_v<Result, Callable&, Arguments...>)
    // NOLINTNEXTLINE(bugprone-forwarding-reference-overload): copies are ruled out above
    FunctionRef(Callable&& callable [[HASHPHASE_LIFETIME_BOUND]])
    noexcept
        : FunctionRef(callable, [](auto& called, Arguments... arguments) -> Result {
              return called(std::forward<Arguments>(arguments)...);
          }) {}

    /// To call adapter(callable, arguments...), of a type that has no members, such as a lambda that captures
    /// nothing.
    template <class Callable, class Adapter>
        requires(std::is_empty_v<Adapter>&&
                     std::is_invocable_r_v<Result, Adapter, Callable&, Arguments...>)
    FunctionRef(Callable&& callable [[HASHPHASE_LIFETIME_BOUND]], Adapter /*adapter*/)
    noexcept {
        using Target = std::remove_reference_t<Callable>;
        if constexpr (std::is_function_v<Target>) {
            object_ = reinterpret_cast<void*>(&callable);
            invoke_ = [](void* object, Arguments... arguments) -> Result {
                return Adapter{}(*reinterpret_cast<Target*>(object),
                                 std::forward<Arguments>(arguments)...);
            };
        } else {
            object_ = const_cast<void*>(static_cast<const void*>(std::addressof(callable)));
            invoke_ = [](void* object, Arguments... arguments) -> Result {
                return Adapter{}(*static_cast<Target*>(object),
                                 std::forward<Arguments>(arguments)...);
            };
        }
    }

    /// Calls the callable, as a non-const one unless it is const itself. Passes on its exceptions. On several
    /// threads at the same time if the callable allows that. Cost: a call through a pointer.
    Result operator()(Arguments... arguments) const {
        return invoke_(object_, std::forward<Arguments>(arguments)...);
    }

private:
    void* object_;  // the callable, or the address of the function
    Result (*invoke_)(void*, Arguments...);
};

}  // namespace hashphase
