// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/proxy_id.hpp>

#include <functional>
#include <limits>

namespace hashphase::test {

/// A collector that calls a function for each proxy found.
struct CallEach {
    std::function<void(ProxyId, float key)> call;

    void add(ProxyId id, float key) { call(id, key); }
    static constexpr float limit() { return std::numeric_limits<float>::infinity(); }
};

}  // namespace hashphase::test
