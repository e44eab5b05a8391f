// SPDX-License-Identifier: Zlib
#pragma once

// Collectors say what a query keeps. A collector has two members:
//
//   add(id, key)   takes a proxy that lies in the region, each at most once a query
//   limit()        the largest key still wanted; below zero the query ends
//
// Each lives on the caller's stack and serves one query on one thread. Queries take it as a variable,
// which has the answer afterwards, not as a temporary.

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

/// Appends every proxy found to a vector of the caller's. The order follows the grid's memory;
/// sort where order matters.
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

/// Counts.
class CollectCount {
public:
    template <class Scalar>
    void add(ProxyId /*id*/, Scalar /*key*/) noexcept {
        ++count_;
    }
    [[nodiscard]] static constexpr double limit() noexcept {
        return std::numeric_limits<double>::infinity();
    }
    [[nodiscard]] std::size_t count() const noexcept { return count_; }

private:
    std::size_t count_ = 0;
};

/// Stops at the first proxy found, whichever it is; null when there is none.
class CollectAny {
public:
    template <class Scalar>
    void add(ProxyId id, Scalar /*key*/) noexcept {
        found_ = id;
    }
    [[nodiscard]] double limit() const noexcept {
        return found_.isNull() ? std::numeric_limits<double>::infinity() : -1.0;
    }
    [[nodiscard]] ProxyId found() const noexcept { return found_; }

private:
    ProxyId found_;
};

/// Keeps the proxy with the smallest key (of equal ones the smallest id), and shrinks the search to
/// what is at least as near.
template <class Scalar>
class CollectClosest {
public:
    void add(ProxyId id, Scalar key) noexcept {
        if (found_.isNull() || std::pair(key, id) < std::pair(key_, found_)) {
            found_ = id;
            key_ = key;
        }
    }
    [[nodiscard]] Scalar limit() const noexcept { return key_; }
    [[nodiscard]] ProxyId found() const noexcept { return found_; }
    [[nodiscard]] Scalar key() const noexcept { return key_; }

private:
    ProxyId found_;
    Scalar key_ = std::numeric_limits<Scalar>::infinity();
};

/// A proxy and its key in the region where it was found.
template <class Scalar>
struct KeyedProxy {
    Scalar key = 0;
    ProxyId id;

    friend constexpr auto operator<=>(const KeyedProxy&, const KeyedProxy&) = default;
};

/// Keeps the `count` proxies with the smallest keys (of equal ones those with the smallest ids), in a
/// vector of the caller's, which is emptied first, and shrinks the search to what may still displace
/// one of them. Cost: O(log count) for each that is kept.
template <class Scalar>
class CollectNearest {
public:
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
    [[nodiscard]] Scalar limit() const noexcept {
        if (nearest_->size() < count_) {
            return std::numeric_limits<Scalar>::infinity();
        }
        return count_ == 0 ? Scalar(-1) : nearest_->front().key;
    }

    /// Ends the search: sorts the vector, nearest first.
    std::span<const KeyedProxy<Scalar>> sort() {
        std::sort_heap(nearest_->begin(), nearest_->end());
        return *nearest_;
    }

private:
    std::size_t count_;
    std::vector<KeyedProxy<Scalar>>* nearest_;  // a heap, the farthest on top
};

/// Sets a bit for every proxy found, by ProxyId::index: bit i % 64 of word i / 64 of a vector of the
/// caller's, which grows where that is needed and is not cleared. The cheapest list of many.
class CollectBits {
public:
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
/// Whether a key is that of something in the region, and no larger than the collector's limit, which
/// may be of the other precision.
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
