// SPDX-License-Identifier: Zlib
#pragma once

// Collectors say what a query keeps. A collector has two members:
//
//   add(id, key)   takes a proxy that lies in the region; a query offers each proxy at most once
//   limit()        returns the largest key still wanted; below zero the query ends
//
//     std::vector<ProxyId> found;
//     CollectAll all(found);
//     grid.visit(BoxRegion<float>{box}, all);  // the answer is in `found`
//
// Use      A collector lives on the caller's stack and serves one query on one thread. Pass a variable, not
//          a temporary: the variable holds the answer after the query.
// Keys     The region defines them (regions.hpp): 0, a squared distance [m^2], or a fraction of a way.
// Own      Any class with these two members is a collector. add() gets keys of the grid's Scalar, limit()
//          may return float or double. A collector that changes the grid may be offered a proxy again: see
//          Callbacks in grid.hpp.
// Filters  CollectIf (proxy_filter.hpp) leaves out proxies before another collector sees them.

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

/// Appends every proxy found to the caller's vector, which keeps what it held and must outlive the
/// collector. The order follows the grid's memory; sort where order matters.
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

/// Counts the proxies found. Serves several queries, too: it goes on counting.
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

/// Ends the query at the first proxy found. Answers "is there any?" at the least cost; which one is found
/// follows the grid's memory, not distance. For the nearest one take CollectClosest.
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
    /// The proxy found; null when there is none.
    [[nodiscard]] ProxyId found() const noexcept { return found_; }

private:
    ProxyId found_;
};

/// Keeps the proxy with the smallest key; of equal keys, the smallest id. Shrinks the search: the query
/// leaves out what is farther away than the closest proxy so far. With a SphereRegion it finds the nearest
/// box, with a RayRegion the first box that the ray enters:
///
///     CollectClosest<float> first;
///     grid.visit(RayRegion<float>(from, to), first);  // first.key(): the fraction of the way
template <class Scalar>
class CollectClosest {
public:
    void add(ProxyId id, Scalar key) noexcept {
        if (found_.isNull() || std::pair(key, id) < std::pair(key_, found_)) {
            found_ = id;
            key_ = key;
        }
    }
    /// The smallest key so far.
    [[nodiscard]] Scalar limit() const noexcept { return key_; }
    /// The closest proxy; null when none was found.
    [[nodiscard]] ProxyId found() const noexcept { return found_; }
    /// The key of found(), in the region's measure; infinity when none was found.
    [[nodiscard]] Scalar key() const noexcept { return key_; }

private:
    ProxyId found_;
    Scalar key_ = std::numeric_limits<Scalar>::infinity();
};

/// A proxy and its key in the region where it was found. Ordered by key, then by id.
template <class Scalar>
struct KeyedProxy {
    Scalar key = 0;  ///< in the region's measure
    ProxyId id;

    friend constexpr auto operator<=>(const KeyedProxy&, const KeyedProxy&) = default;
};

/// Keeps the `count` proxies with the smallest keys; of equal keys, those with the smallest ids. Shrinks the
/// search to proxies that may still displace one of them. Cost: O(log count) for each proxy kept.
///
///     std::vector<KeyedProxy<float>> nearest;
///     CollectNearest<float> five(5, nearest);
///     grid.visit(SphereRegion<float>(center, radius), five);
///     for (const KeyedProxy<float>& found : five.sort()) { ... }
template <class Scalar>
class CollectNearest {
public:
    /// Keeps them in `nearest`, which is emptied here and must outlive the collector. With a count of 0
    /// nothing is kept.
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
    /// Infinity until `count` proxies are kept, then the largest key among them.
    [[nodiscard]] Scalar limit() const noexcept {
        if (nearest_->size() < count_) {
            return std::numeric_limits<Scalar>::infinity();
        }
        return count_ == 0 ? Scalar(-1) : nearest_->front().key;
    }

    /// Sorts the vector, nearest first, and returns it. Call it once, after the query: until then the
    /// vector is a heap. Fewer than `count` proxies when the region has fewer. Cost: O(count log count).
    std::span<const KeyedProxy<Scalar>> sort() {
        std::sort_heap(nearest_->begin(), nearest_->end());
        return *nearest_;
    }

private:
    std::size_t count_;
    std::vector<KeyedProxy<Scalar>>* nearest_;  // a heap, the farthest on top
};

/// Sets a bit for every proxy found: bit i % 64 of word i / 64 stands for the ProxyId::index i. The cheapest
/// list of many proxies. Grid::idAt() leads from an index back to the id.
class CollectBits {
public:
    /// Sets bits in the caller's vector, which grows as needed. Bits already set stay set, so that several
    /// queries can be united. Only the collector may resize the vector while it is in use.
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
/// True when the key is that of a box in the region (0 or more) and no larger than the collector's limit.
/// The limit may be of the other precision.
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
