// SPDX-License-Identifier: Zlib
#pragma once

// Filters that decide which proxies a query may find.

#include <broadphase/function_ref.hpp>
#include <broadphase/proxy_id.hpp>

#include <utility>

namespace hashphase {

/// Returns whether a query may find a proxy, for example because of its team, or its group and mask
/// (integration/bullet/group_filter.hpp). A query asks only about proxies in its region, on the query's threads.
///
/// Use ProxyFilter only for parameters: it refers to the function. In variables, keep the function itself:
///
///     const auto enemies = [&](ProxyId id) { return team[id.index] != team[self.index]; };  // right
///     const ProxyFilter enemies = [&](ProxyId id) { ... };  // wrong: the lambda is destroyed (Clang warns)
using ProxyFilter = FunctionRef<bool(ProxyId)>;

/// The filter that accepts every proxy.
[[nodiscard]] inline bool acceptAll(ProxyId /*id*/) noexcept {
    return true;
}

/// Passes to another collector only the proxies that a filter accepts:
///
///     CollectIf enemies(all, [&](ProxyId id) { ... });
///     grid.visit(region, enemies);
///
/// In the query's cost, `hits` counts the proxies that the filter was asked about.
template <class Collector, class Filter>
class CollectIf {
public:
    /// `collector` must outlive this object. Copies `filter`, a bool(ProxyId) function.
    CollectIf(Collector& collector, Filter filter)
        : collector_(collector), filter_(std::move(filter)) {}

    template <class Scalar>
    void add(ProxyId id, Scalar key) {
        if (filter_(id)) {
            collector_.add(id, key);
        }
    }
    /// Returns the limit of the other collector: only accepted proxies can shrink the search.
    [[nodiscard]] auto limit() const { return collector_.limit(); }

private:
    Collector& collector_;
    Filter filter_;
};

}  // namespace hashphase
