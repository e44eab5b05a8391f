// SPDX-License-Identifier: Zlib
#pragma once

// A number for a list of results: the same where they are the same to the last bit, and else, as good as
// certainly, another one.

#include <integration/ai/zones.hpp>

#include <broadphase/aabb.hpp>
#include <broadphase/proxy_id.hpp>

#include <bit>
#include <cstdint>

namespace hashphase::demos {

/// FNV-1a, by Fowler, Noll and Vo.
class ResultHash {
public:
    void add(std::uint64_t number) { value_ = (value_ ^ number) * 0x100000001b3U; }
    void add(const Vector3<float>& vector) {
        for (int axis = 0; axis < 3; ++axis) {
            add(std::bit_cast<std::uint32_t>(vector[axis]));
        }
    }
    void add(ProxyId id) { add(std::uint64_t{id.index}); }
    void add(const ZoneEvent& event) {
        add(event.zone.index);
        add(event.proxy);
    }
    void add(const ProxyPair& pair) {
        add(pair.first);
        add(pair.second);
    }
    template <class List>
    void addAll(const List& list) {
        for (const auto& item : list) {
            add(item);
        }
        add(list.size());
    }
    [[nodiscard]] std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_ = 0xcbf29ce484222325U;
};

}  // namespace hashphase::demos
