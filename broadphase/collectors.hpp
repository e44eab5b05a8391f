// SPDX-License-Identifier: Zlib
#pragma once

// Collectors say what a query keeps. A collector has two members:
//
//   add(id, key)   takes a proxy that lies in the region, each at most once a query
//   limit()        the largest key still wanted; below zero the query ends
//
// Each lives on the caller's stack and serves one query on one thread.

#include <broadphase/proxy_id.hpp>

#include <cstddef>
#include <limits>
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

}  // namespace hashphase
