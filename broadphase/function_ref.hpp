// SPDX-License-Identifier: Zlib
#pragma once

// A reference to a function. Use it as a parameter type: it is cheaper than std::function, which owns a copy.
//
//     void visitAll(FunctionRef<void(ProxyId)> visit);
//     visitAll([&](ProxyId id) { ... });                     // right: the lambda exists until the call ends
//     FunctionRef<void(ProxyId)> visit = [&](ProxyId) { };   // wrong: the lambda is destroyed after this line

#include <broadphase/core/compiler.hpp>
#include <broadphase/export.hpp>

#include <memory>
#include <type_traits>
#include <utility>

namespace hashphase {

template <class Signature>
class FunctionRef;

/// A reference to a lambda, a function or a function object. Use it only for parameters: the callable must exist as
/// long as the FunctionRef. To store a lambda, declare it as `const auto`. A FunctionRef holds two pointers, never
/// allocates, and is never empty.
template <class Result, class... Arguments>
class FunctionRef<Result(Arguments...)> {
public:
    /// Refers to `callable`, which takes Arguments, and returns Result or a type that converts to Result.
    template <class Callable>
        requires(!std::is_same_v<std::remove_cvref_t<Callable>, FunctionRef> &&
                 std::is_invocable_r_v<Result, Callable&, Arguments...>)
    // NOLINTNEXTLINE(bugprone-forwarding-reference-overload): the constraint excludes copies
    FunctionRef(Callable&& callable [[HASHPHASE_LIFETIME_BOUND]])
    noexcept
        : FunctionRef(callable, [](auto& called, Arguments... arguments) -> Result {
              return called(std::forward<Arguments>(arguments)...);
          }) {}

    /// After this constructor, operator() returns adapter(callable, arguments...). The adapter's type must have no
    /// data members, like a lambda without captures.
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

    /// Calls the callable: as const if the callable is const, otherwise as non-const. Exceptions of the callable pass
    /// through. Threads: as for the callable itself. Cost: a call through a pointer.
    Result operator()(Arguments... arguments) const {
        return invoke_(object_, std::forward<Arguments>(arguments)...);
    }

private:
    void* object_;  // the callable, or the address of the function
    Result (*invoke_)(void*, Arguments...);
};

}  // namespace hashphase
