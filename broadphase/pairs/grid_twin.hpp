// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/pairs/pair_state.hpp>
#include <broadphase/store/motions.hpp>
#include <broadphase/store/store.hpp>

namespace hashphase::detail {

/// What a grid, its pairs and its sweeps are made of; null for those that it lacks.
template <class Store, class PairState, class Motions>
struct Side {
    Store* store;
    PairState* pairs;
    Motions* motions;
};

// For Clang before 17, which finds none for such a class.
template <class Store, class PairState, class Motions>
Side(Store*, PairState*, Motions*) -> Side<Store, PairState, Motions>;

/// The same once more.
template <class Scalar>
struct GridTwin {
    Store<Scalar> store;
    Motions<Scalar> motions{store};
    PairState<Scalar> pairs{store, nullptr};
    bool hasPairs = false;
    bool hasSweeps = false;

    explicit GridTwin(const GridConfig& config) : store(config) {}
    ~GridTwin() { store.proxies.sweeping.clear(); }  // which is the grid's to end
    GridTwin(const GridTwin&) = delete;
    GridTwin& operator=(const GridTwin&) = delete;

    [[nodiscard]] auto side() { return sideOf(*this); }
    [[nodiscard]] auto side() const { return sideOf(*this); }

private:
    [[nodiscard]] static auto sideOf(auto& twin) {
        return Side{&twin.store, twin.hasPairs ? &twin.pairs : nullptr,
                    twin.hasSweeps ? &twin.motions : nullptr};
    }
};

}  // namespace hashphase::detail
