// SPDX-License-Identifier: Zlib
#pragma once

// A world beside the list of what it holds: what most tests of the grid and its pairs begin with.

#include <tests/support/box_scenes.hpp>
#include <tests/support/query_checks.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace hashphase::test {

/// A World (tests/support/script.hpp), its proxies for brute force, and the random numbers that they are
/// drawn from.
template <class Scalar, template <class> class World = GridWorld>
struct Population : World<Scalar> {
    using Base = World<Scalar>;
    using Box = Aabb<Scalar>;
    using Base::Base;

    Random random{0x5eed0001};
    std::vector<Placed<Scalar>> proxies;

    ProxyId add(const Box& box, Mobility mobility = Mobility::mobile) {
        proxies.push_back({Base::add(box, mobility), box});
        return proxies.back().id;
    }
    /// Adds so many as draw(Random&) makes; the first of each `restingEach` is said to rest.
    template <class Draw>
    void addMany(std::size_t count, Draw draw, std::size_t restingEach = 0) {
        for (std::size_t i = 0; i < count; ++i) {
            const bool rests = restingEach != 0 && i % restingEach == 0;
            add(draw(random), rests ? Mobility::resting : Mobility::mobile);
        }
    }
    void moveTo(std::size_t i, const Box& box) {
        proxies[i].box = box;
        Base::move(proxies[i].id, box);
    }
    /// Moves those in the list from `first` up to `last` by up to `by` [m] along each axis from their homes, which
    /// is where they were added.
    void tremble(std::size_t first = 0, std::size_t last = ~std::size_t{0}, double by = 0.01) {
        for (std::size_t i = first; i < std::min(last, proxies.size()); ++i) {
            moveTo(i, shifted(random, proxies[i].home, by));
        }
    }
    /// The last one takes its place in the list.
    void removeAt(std::size_t i) {
        Base::remove(proxies[i].id);
        proxies[i] = proxies.back();
        proxies.pop_back();
    }
    /// Removes all whose place in the list isKept(i) does not accept.
    template <class IsKept>
    void keepOnly(const IsKept& isKept) {
        std::vector<Placed<Scalar>> kept;
        for (std::size_t i = 0; i < proxies.size(); ++i) {
            if (isKept(i)) {
                kept.push_back(proxies[i]);
            } else {
                Base::remove(proxies[i].id);
            }
        }
        proxies.swap(kept);
    }
    void paint(std::size_t i, std::uint32_t colour) {
        proxies[i].colour = colour;
        this->colours.set(proxies[i].id, colour);
    }
    void shift(const Vector3<Scalar>& by) {
        Base::shiftOrigin(by);
        for (Placed<Scalar>& proxy : proxies) {
            proxy.box = {proxy.box.min() - by, proxy.box.max() - by};
            proxy.home = {proxy.home.min() - by, proxy.home.max() - by};
        }
    }
    /// A place in the list.
    [[nodiscard]] std::size_t any() {
        return random.below(static_cast<std::uint32_t>(proxies.size()));
    }

    template <class Region>
    std::size_t expectLikeBruteForce(const Region& region) const {
        return test::expectLikeBruteForce<Scalar>(this->grid, proxies, region);
    }
    std::size_t expectQueriesLikeBruteForce(int count) {
        return test::expectQueriesLikeBruteForce<Scalar>(this->grid, proxies, random, count);
    }
    /// Ends the frame of a world with pairs; they are those of brute force, and all accounts agree.
    void updateAndCheck() {
        this->update();
        this->checkThoroughly(proxies);
    }
};

}  // namespace hashphase::test
