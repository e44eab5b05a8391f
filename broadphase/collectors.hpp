// SPDX-License-Identifier: Zlib
#pragma once

// Collectors receive the proxies that a query finds, and decide which to keep. A collector has two members:
//
//   add(id, key)   receives each proxy in the region whose key is at most limit(); no proxy twice, unless the
//                  collector changes this proxy in the grid
//   limit()        returns the largest key still wanted; a negative limit ends the query
//
//     std::vector<ProxyId> found;
//     CollectAll all(found);
//     grid.visit(BoxRegion<float>{box}, all);  // the answer is in `found`
//
// Use      Pass a variable, not a temporary. After the query, the answer is in the collector, or in the vector that
//          its constructor received. Do not use a collector in two queries at the same time.
// Keys     The region defines the keys (regions.hpp): 0, a squared distance [m^2], or a fraction of a path.
// Own      Any class with these members is a collector. add() receives keys of the grid's Scalar; limit() may return
//          float or double. For collectors that change the grid, see Callbacks in grid.hpp.
// Filters  CollectIf (proxy_filter.hpp) passes proxies to another collector, but only those that a filter accepts.

#include <broadphase/proxy_id.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace hashphase {

/// Appends every proxy found to the caller's vector, which must outlive the collector. The order depends on the
/// grid's memory layout; sort the vector if order matters.
class CollectAll {
public:
    explicit CollectAll(std::vector<ProxyId>& found) noexcept : found_(&found) {}

    template <class Scalar>
    void add(ProxyId id, Scalar /*key*/) {
        found_->push_back(id);
    }
    [[nodiscard]] static constexpr double limit() noexcept {
        return std::numeric_limits<double>::infinity();
    }

private:
    std::vector<ProxyId>* found_;
};

/// Counts the proxies that one or more queries find.
class CollectCount {
public:
    template <class Scalar>
    void add(ProxyId /*id*/, Scalar /*key*/) noexcept {
        ++count_;
    }
    [[nodiscard]] static constexpr double limit() noexcept {
        return std::numeric_limits<double>::infinity();
    }
    /// Number of proxies found so far.
    [[nodiscard]] std::size_t count() const noexcept { return count_; }

private:
    std::size_t count_ = 0;
};

/// Ends the query at the first proxy found. This is the cheapest test whether a region contains any proxy. Which
/// proxy is found depends on the grid's memory layout; CollectClosest finds the nearest.
class CollectAny {
public:
    template <class Scalar>
    void add(ProxyId id, Scalar /*key*/) noexcept {
        found_ = id;
    }
    /// Infinity until a proxy is found, then -1.
    [[nodiscard]] double limit() const noexcept {
        return found_.isNull() ? std::numeric_limits<double>::infinity() : -1.0;
    }
    /// The proxy found; a null id if there is none.
    [[nodiscard]] ProxyId found() const noexcept { return found_; }

private:
    ProxyId found_;
};

/// Keeps the proxy with the smallest key; if keys are equal, the smallest id. Each closer proxy shrinks the search.
/// With a SphereRegion, finds the nearest box; with a RayRegion, the first box on the ray:
///
///     CollectClosest<float> first;
///     grid.visit(RayRegion<float>(from, to), first);  // first.key(): the fraction of the ray
template <class Scalar>
class CollectClosest {
public:
    void add(ProxyId id, Scalar key) noexcept {
        if (found_.isNull() || std::pair(key, id) < std::pair(key_, found_)) {
            found_ = id;
            key_ = key;
        }
    }
    /// The smallest key so far; infinity if none was found.
    [[nodiscard]] Scalar limit() const noexcept { return key_; }
    /// The closest proxy; a null id if none was found.
    [[nodiscard]] ProxyId found() const noexcept { return found_; }
    /// The key of found(), as the region defines it; infinity if none was found.
    [[nodiscard]] Scalar key() const noexcept { return key_; }

private:
    ProxyId found_;
    Scalar key_ = std::numeric_limits<Scalar>::infinity();
};

/// A proxy and its key in the region. Sorts by key, then by id.
template <class Scalar>
struct KeyedProxy {
    Scalar key = 0;  ///< defined by the region
    ProxyId id;

    friend constexpr auto operator<=>(const KeyedProxy&, const KeyedProxy&) = default;
};

/// Keeps the `count` proxies with the smallest keys; if keys are equal, the smallest ids. After `count` proxies, each
/// closer proxy shrinks the search. Cost: O(log count) for each proxy kept.
///
///     std::vector<KeyedProxy<float>> nearest;
///     CollectNearest<float> five(5, nearest);
///     grid.visit(SphereRegion<float>(center, radius), five);
///     for (const KeyedProxy<float>& found : five.sort()) { ... }
template <class Scalar>
class CollectNearest {
public:
    /// Clears `nearest`, and stores the proxies there. `nearest` must outlive the collector.
    CollectNearest(std::size_t count, std::vector<KeyedProxy<Scalar>>& nearest)
        : count_(count), nearest_(&nearest) {
        nearest_->clear();
    }

    void add(ProxyId id, Scalar key) {
        const KeyedProxy<Scalar> found{key, id};
        if (nearest_->size() == count_) {
            if (count_ == 0 || !(found < nearest_->front())) {
                return;
            }
            std::pop_heap(nearest_->begin(), nearest_->end());
            nearest_->pop_back();
        }
        nearest_->push_back(found);
        std::push_heap(nearest_->begin(), nearest_->end());
    }
    /// Infinity until `count` proxies are kept; afterwards their largest key. -1 if `count` is 0.
    [[nodiscard]] Scalar limit() const noexcept {
        if (nearest_->size() < count_) {
            return std::numeric_limits<Scalar>::infinity();
        }
        return count_ == 0 ? Scalar(-1) : nearest_->front().key;
    }

    /// Sorts the vector by ascending key, and returns it. Call sort() once, after the last query with this
    /// collector: until then, the vector is a heap. Cost: O(count log count).
    std::span<const KeyedProxy<Scalar>> sort() {
        std::sort_heap(nearest_->begin(), nearest_->end());
        return *nearest_;
    }

private:
    std::size_t count_;
    std::vector<KeyedProxy<Scalar>>* nearest_;  // a heap with the largest key on top
};

/// Sets a bit for every proxy found: bit i % 64 of word i / 64, where i is ProxyId::index. Bits are the cheapest
/// way to store many found proxies. Grid::idAt() returns the id of an index.
class CollectBits {
public:
    /// Sets bits in the caller's vector, and enlarges it as needed. Bits already set stay set. From this
    /// constructor until the last query with the collector, no other code may resize the vector.
    explicit CollectBits(std::vector<std::uint64_t>& bits) noexcept
        : bits_(&bits), words_(bits.data()), wordCount_(bits.size()) {}

    template <class Scalar>
    void add(ProxyId id, Scalar /*key*/) {
        const std::size_t word = id.index / 64;
        if (word >= wordCount_) {
            bits_->resize(word + 1);
            words_ = bits_->data();
            wordCount_ = bits_->size();
        }
        words_[word] |= std::uint64_t{1} << (id.index % 64);
    }
    [[nodiscard]] static constexpr double limit() noexcept {
        return std::numeric_limits<double>::infinity();
    }

private:
    std::vector<std::uint64_t>* bits_;
    std::uint64_t* words_;
    std::size_t wordCount_;
};

namespace detail {
/// True when the proxy is in the region (key >= 0) and the collector wants it (key <= limit()). key and limit()
/// may differ in precision.
template <class Scalar, class Collector>
[[nodiscard]] bool isWanted(Scalar key, const Collector& collector) {
    const auto limit = collector.limit();
    if constexpr (std::is_same_v<decltype(limit), const Scalar>) {
        return key >= 0 && key <= limit;
    } else {
        return key >= 0 && static_cast<double>(key) <= static_cast<double>(limit);
    }
}
}  // namespace detail

}  // namespace hashphase
