// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/function_ref.hpp>
#include <broadphase/proxy_id.hpp>

#include <utility>

namespace hashphase {

/// Says whether a query may find a proxy: by group and mask (integration/bullet/group_filter.hpp), by
/// team, by anything that the caller keeps by ProxyId::index. Asked about what lies in the region
/// only. Queries that run on several threads ask on all of them.
///
/// For parameters only: it refers to the function that it is made of, and keeps no copy. Keep the function:
/// `const auto enemies = [&](ProxyId id) { ... };`. As `const ProxyFilter enemies = [&] ...` it would be gone
/// at the end of the line (Clang warns).
using ProxyFilter = FunctionRef<bool(ProxyId)>;

/// The filter that refuses nothing.
[[nodiscard]] inline bool acceptAll(ProxyId /*id*/) noexcept {
    return true;
}

/// A collector that hands on to another one, which must outlive it, what the filter accepts, of which it
/// keeps a copy: CollectIf enemies(all, [&](ProxyId id) { ... }). Of a query's cost, `hits` are those
/// that were asked about.
template <class Collector, class Filter>
class CollectIf {
public:
    CollectIf(Collector& collector, Filter filter)
        : collector_(collector), filter_(std::move(filter)) {}

    template <class Scalar>
    void add(ProxyId id, Scalar key) {
        if (filter_(id)) {
            collector_.add(id, key);
        }
    }
    [[nodiscard]] auto limit() const { return collector_.limit(); }

private:
    Collector& collector_;
    Filter filter_;
};

}  // namespace hashphase
