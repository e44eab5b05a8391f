// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/function_ref.hpp>
#include <broadphase/proxy_id.hpp>

#include <utility>

namespace hashphase {

/// Says whether a query may find a proxy: by group and mask (integration/bullet/group_filter.hpp), by team,
/// or by any data that the caller keeps by ProxyId::index. Asked only about proxies in the region. Queries
/// that run on several threads ask on all of them.
///
/// For parameters only: a filter refers to the function that it is made of, and keeps no copy. Keep the
/// function itself:
///
///     const auto enemies = [&](ProxyId id) { return team[id.index] != team[self.index]; };  // right
///     const ProxyFilter enemies = [&](ProxyId id) { ... };  // wrong: the lambda is gone (Clang warns)
using ProxyFilter = FunctionRef<bool(ProxyId)>;

/// The filter that refuses nothing.
[[nodiscard]] inline bool acceptAll(ProxyId /*id*/) noexcept {
    return true;
}

/// A collector that hands on to another collector what the filter accepts:
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
    /// That of the other collector, so that the search shrinks as with it alone.
    [[nodiscard]] auto limit() const { return collector_.limit(); }

private:
    Collector& collector_;
    Filter filter_;
};

}  // namespace hashphase
