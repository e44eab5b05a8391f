// SPDX-License-Identifier: Zlib
#pragma once

// What the grid and its pairs must answer, found by looking at everything.

#include <broadphase/aabb.hpp>
#include <broadphase/proxy_id.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>
#include <ostream>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace hashphase {

// For GoogleTest.
inline void PrintTo(const ProxyId& id, std::ostream* out) {
    *out << id.index << '#' << id.generation;
}
inline void PrintTo(const ProxyPair& pair, std::ostream* out) {
    PrintTo(pair.first, out);
    *out << '-';
    PrintTo(pair.second, out);
}

}  // namespace hashphase

namespace hashphase::test {

/// A proxy as the test knows it. Proxies of one colour above zero refuse to pair with each other.
template <class Scalar>
struct Placed {
    ProxyId id;
    Aabb<Scalar> box;
    std::uint32_t colour = 0;
    Aabb<Scalar> home = box;  // where it was when it was listed, see Population::tremble()
};

[[nodiscard]] inline bool coloursPair(std::uint32_t a, std::uint32_t b) noexcept {
    return a != b || a == 0;
}

/// A filter that the colours of proxies make; 0 unless they are set.
class Colours {
public:
    void set(ProxyId id, std::uint32_t colour) {
        of_.resize(std::max<std::size_t>(of_.size(), id.index + std::size_t{1}));
        of_[id.index] = colour;
    }
    [[nodiscard]] bool accept(ProxyId a, ProxyId b) const { return coloursPair(of(a), of(b)); }
    [[nodiscard]] std::uint32_t of(ProxyId id) const {
        return id.index < of_.size() ? of_[id.index] : 0;
    }

private:
    std::vector<std::uint32_t> of_;  // by index of proxy
};

[[nodiscard]] inline ProxyPair makePair(ProxyId a, ProxyId b) noexcept {
    return a < b ? ProxyPair{a, b} : ProxyPair{b, a};
}

/// How two sorted lists differ, in a few words; empty when they are equal.
template <class Item>
[[nodiscard]] std::string differences(const std::vector<Item>& actual,
                                      const std::vector<Item>& expected) {
    if (actual == expected) {
        return {};
    }
    const auto list = [](const char* title, const std::vector<Item>& from,
                         const std::vector<Item>& less) {
        std::vector<Item> only;
        std::set_difference(from.begin(), from.end(), less.begin(), less.end(),
                            std::back_inserter(only));
        std::string text = title + std::to_string(only.size());
        for (std::size_t i = 0; i < std::min<std::size_t>(only.size(), 4); ++i) {
            text += ' ' + testing::PrintToString(only[i]);
        }
        return text;
    };
    return list("missing: ", expected, actual) + list("; too many: ", actual, expected);
}

/// Grid::visit() by looking at everything, in the order given. The region's key() decides.
template <class Scalar, class Region, class Collector>
void visitByBruteForce(std::span<const Placed<Scalar>> proxies, const Region& region,
                       Collector& collector) {
    for (const Placed<Scalar>& proxy : proxies) {
        const Scalar key = region.key(proxy.box);
        if (key >= 0 && key <= collector.limit()) {
            collector.add(proxy.id, key);
            if (!(collector.limit() >= 0)) {
                return;
            }
        }
    }
}

/// All pairs of which doMeet(Placed, Placed) is true and whose colours pair, sorted.
template <class Scalar, class DoMeet>
[[nodiscard]] std::vector<ProxyPair> pairsByBruteForce(std::span<const Placed<Scalar>> proxies,
                                                       const DoMeet& doMeet) {
    std::vector<ProxyPair> pairs;
    for (std::size_t i = 0; i < proxies.size(); ++i) {
        for (std::size_t j = i + 1; j < proxies.size(); ++j) {
            if (doMeet(proxies[i], proxies[j]) &&
                coloursPair(proxies[i].colour, proxies[j].colour)) {
                pairs.push_back(makePair(proxies[i].id, proxies[j].id));
            }
        }
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

/// All overlapping pairs whose colours pair, sorted.
template <class Scalar>
[[nodiscard]] std::vector<ProxyPair> pairsByBruteForce(std::span<const Placed<Scalar>> proxies) {
    return pairsByBruteForce(proxies, [](const Placed<Scalar>& a, const Placed<Scalar>& b) {
        return overlaps(a.box, b.box);
    });
}

/// A collector that keeps every proxy with its key.
template <class Scalar>
class CollectKeys {
public:
    using Found = std::vector<std::pair<ProxyId, Scalar>>;

    void add(ProxyId id, Scalar key) { found_.emplace_back(id, key); }
    [[nodiscard]] static constexpr double limit() noexcept {
        return std::numeric_limits<double>::infinity();
    }

    /// Sorted; a proxy found twice stands in it twice.
    [[nodiscard]] Found sorted() const {
        Found sorted = found_;
        std::sort(sorted.begin(), sorted.end());
        return sorted;
    }

private:
    Found found_;
};

}  // namespace hashphase::test
