// SPDX-License-Identifier: Zlib
#pragma once

// How bodies move, and how the grid learns of it, in the same pass where nothing comes between.

#include <integration/effects/detail/simulation_parts.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hashphase {
namespace {

/// Inlined, so that the position stays in registers: what is stored in parts and read at once as a
/// whole waits for the memory.
template <class Scalar>
[[HASHPHASE_ALWAYS_INLINE]] inline void turnBack(Vector3<Scalar>& position,
                                                 Vector3<Scalar>& velocity,
                                                 const Vector3<Scalar>& low,
                                                 const Vector3<Scalar>& high) {
    for (int axis = 0; axis < 3; ++axis) {
        if (position[axis] < low[axis]) {
            position[axis] = low[axis];
            velocity[axis] = std::abs(velocity[axis]);
        } else if (position[axis] > high[axis]) {
            position[axis] = high[axis];
            velocity[axis] = -std::abs(velocity[axis]);
        }
    }
}

}  // namespace

// Gives the grid the boxes of bodies, and measures how far any corner has moved where that is wanted.
template <class Scalar>
template <typename Simulation<Scalar>::Filing filing>
class Simulation<Scalar>::BodyFiler {
public:
    explicit BodyFiler(Index* index)
        : grid_(filing == Filing::none ? nullptr : &index->grid),
          proxies_(filing == Filing::none ? std::span<const ProxyId>() : index->proxies) {}

    void file([[maybe_unused]] std::uint32_t body, [[maybe_unused]] const Point& position,
              [[maybe_unused]] Scalar radius) {
        if constexpr (filing != Filing::none) {
            const Aabb<Scalar> box = boxAt(position, radius);
            if constexpr (filing == Filing::measured) {
                const Aabb<Scalar>& before = grid_->box(proxies_[body]);
                const Point corner = (box.min() - before.min())
                                         .cwiseAbs()
                                         .cwiseMax((box.max() - before.max()).cwiseAbs());
                farthestSquared_ = std::max(farthestSquared_, corner.squaredNorm());
            }
            grid_->move(proxies_[body], box);
        }
    }

    /// [m], rounded up.
    [[nodiscard]] Scalar farthest() const {
        return std::sqrt(farthestSquared_) * (1 + 4 * std::numeric_limits<Scalar>::epsilon());
    }

private:
    Grid<Scalar>* grid_;
    std::span<const ProxyId> proxies_;
    Scalar farthestSquared_ = 0;
};

// Unless it is measured, nobody knows how far somebody has moved.
template <class Scalar>
void Simulation<Scalar>::note(Filing filing, Scalar farthest) {
    if (filing == Filing::none) {
        return;
    }
    constexpr Scalar infinity = std::numeric_limits<Scalar>::infinity();
    const std::size_t count = motion_->movers.size();
    farthestMove_ = filing == Filing::measured ? farthest : count == 0 ? 0 : infinity;
    cost_[SceneCounter::proxiesHashed] += count;
}

// Where nothing comes between, bodies are filed in the same pass.
template <class Scalar>
template <bool isBounded, typename Simulation<Scalar>::Filing filing>
void Simulation<Scalar>::moveBodies() {
    const Point low = effects_.motion->bounds.min().template cast<Scalar>();
    const Point high = effects_.motion->bounds.max().template cast<Scalar>();
    const std::span<Point> positions = positions_;
    const std::span<Point> velocities = motion_->velocities;
    const std::span<const Scalar> radii = radii_;
    const std::span<const std::uint32_t> movers = motion_->movers;
    BodyFiler<filing> filer(index_.get());
    const Scalar seconds = seconds_;
    const bool isInOrder = movers.size() == positions.size();
    for (std::size_t i = 0; i < movers.size(); ++i) {
        const std::uint32_t body = isInOrder ? static_cast<std::uint32_t>(i) : movers[i];
        Point& velocity = velocities[body];
        Point position = positions[body] + velocity * seconds;
        if constexpr (isBounded) {
            turnBack(position, velocity, low, high);
        }
        positions[body] = position;
        filer.file(body, position, radii[body]);
    }
    cost_[SceneCounter::bodiesMoved] += movers.size();
    note(filing, filer.farthest());
}

template <class Scalar>
auto Simulation<Scalar>::movePhase(bool isBounded, Filing filing) -> Phase {
    switch (filing) {
        case Filing::none:
            return {"move", isBounded ? &Simulation::moveBodies<true, Filing::none>
                                      : &Simulation::moveBodies<false, Filing::none>};
        case Filing::plain:
            return {"move and file", isBounded ? &Simulation::moveBodies<true, Filing::plain>
                                               : &Simulation::moveBodies<false, Filing::plain>};
        case Filing::measured:
            break;
    }
    return {"move and file", isBounded ? &Simulation::moveBodies<true, Filing::measured>
                                       : &Simulation::moveBodies<false, Filing::measured>};
}

template <class Scalar>
template <typename Simulation<Scalar>::Filing filing>
void Simulation<Scalar>::fileBodies() {
    BodyFiler<filing> filer(index_.get());
    for (const std::uint32_t body : motion_->movers) {
        filer.file(body, positions_[body], radii_[body]);
    }
    note(filing, filer.farthest());
}

template <class Scalar>
void Simulation<Scalar>::file() {
    fileBodies<Filing::plain>();
}

template <class Scalar>
void Simulation<Scalar>::fileAndMeasure() {
    fileBodies<Filing::measured>();
}

}  // namespace hashphase
