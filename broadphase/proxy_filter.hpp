// SPDX-License-Identifier: Zlib
#pragma once

// Filters that decide which proxies a query may find.

#include <broadphase/function_ref.hpp>
#include <broadphase/proxy_id.hpp>

#include <utility>

namespace hashphase {

/// Returns whether a query may find a proxy, for example by team or by group and mask
/// (integration/bullet/group_filter.hpp). Asked only about proxies in the region. Threads: those of the query.
///
/// For parameters only: it refers to the function. Keep the function itself:
///
///     const auto enemies = [&](ProxyId id) { return team[id.index] != team[self.index]; };  // right
///     const ProxyFilter enemies = [&](ProxyId id) { ... };  // wrong: the lambda is gone (Clang warns)
using ProxyFilter = FunctionRef<bool(ProxyId)>;

/// The filter that accepts every proxy.
[[nodiscard]] inline bool acceptAll(ProxyId /*id*/) noexcept {
    return true;
}

/// Passes the proxies that a filter accepts to another collector:
///
///     CollectIf enemies(all, [&](ProxyId id) { ... });
///     grid.visit(region, enemies);
///
/// In the query's cost, `hits` counts the proxies that the filter was asked about.
template <class Collector, class Filter>
class CollectIf {
public:
    /// The other collector must outlive this one. The filter, bool(ProxyId), is copied.
    CollectIf(Collector& collector, Filter filter)
        : collector_(collector), filter_(std::move(filter)) {}

    template <class Scalar>
    void add(ProxyId id, Scalar key) {
        if (filter_(id)) {
            collector_.add(id, key);
        }
    }
    /// The other collector's limit, so that the search shrinks as for it alone.
    [[nodiscard]] auto limit() const { return collector_.limit(); }

private:
    Collector& collector_;
    Filter filter_;
};

}  // namespace hashphase
