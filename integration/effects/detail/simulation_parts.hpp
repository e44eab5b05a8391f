// SPDX-License-Identifier: Zlib
#pragma once

// The tables of a Simulation's effects; each is there while its effect is declared.

#include <broadphase/sweeps.hpp>
#include <integration/effects/simulation.hpp>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace hashphase {

template <class Scalar>
struct Simulation<Scalar>::Motion {
    std::vector<Point> velocities;
    std::vector<std::uint32_t> movers;  // who is awake
};

template <class Scalar>
struct Simulation<Scalar>::Walkers {
    explicit Walkers(UpAxis axis)
        : up(static_cast<Eigen::Index>(axis)), grid(), terrain(grid, axis) {}

    void clear() noexcept {
        bodies.clear();
        centers.clear();
        radii.clear();
    }

    Eigen::Index up;
    Grid<Scalar> grid;  // of the triangles
    Terrain<Scalar> terrain;
    std::vector<std::uint32_t> bodies;  // whose height is to be asked for
    std::vector<Point> centers;
    std::vector<Scalar> radii;
    std::vector<std::optional<Ground<Scalar>>> found;
};

template <class Scalar>
struct Simulation<Scalar>::Sleep {
    enum class State : std::uint8_t { awake, slow, distant };

    std::vector<State> states;
    std::vector<std::uint32_t> slowFrames;  // how many in a row, until now
    std::size_t farCount = 0;
    std::optional<Point> interest;  // of the frame: who is far from it
    bool mustLook = false;          // again, though it is the same
};

template <class Scalar>
struct Simulation<Scalar>::Index {
    explicit Index(const GridConfig& gridConfig) : config(gridConfig), grid(gridConfig) {}

    GridConfig config;
    Grid<Scalar> grid;
    std::vector<ProxyId> proxies;  // by body
    bool isFiling = true;          // somebody takes part in an effect that asks the grid
};

template <class Scalar>
struct Simulation<Scalar>::Pairing {
    explicit Pairing(Grid<Scalar>& grid) : pairs(grid) {}

    void setSweeps(Grid<Scalar>& grid, bool areWanted) {
        if (areWanted != (sweeps != nullptr)) {
            auto wanted = areWanted ? std::make_unique<Sweeps<Scalar>>(grid) : nullptr;
            pairs.setSweeps(wanted.get());
            sweeps = std::move(wanted);
        }
    }

    std::unique_ptr<Sweeps<Scalar>> sweeps;
    Pairs<Scalar> pairs;
    PairChanges changes;
    bool isSpent = false;  // nobody takes part any more, and that has been told
};

template <class Scalar>
struct Simulation<Scalar>::Contacts {
    struct BodyPair {
        std::uint32_t first;
        std::uint32_t second;

        friend constexpr auto operator<=>(const BodyPair&, const BodyPair&) = default;
    };

    std::vector<BodyPair> present;  // sorted
    std::vector<BodyPair> next;
    bool isCurrent = true;  // else nobody responded, and nobody kept them
};

template <class Scalar>
struct Simulation<Scalar>::Sweepers {
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};

    struct Sweeper {
        std::uint32_t body;
        std::uint32_t hit = kNone;  // whom it meets first
        Point start;
        Point velocity;  // there; a wall behind what it meets has not turned it back
        Point way = Point::Zero();
        double time = 1;  // when, as a share of the frame
    };

    [[nodiscard]] bool has(std::uint32_t body) const noexcept { return ofBody[body] != kNone; }
    [[nodiscard]] Point wayOf(std::uint32_t body) const {
        return has(body) ? list[ofBody[body]].way : Point(Point::Zero());
    }

    std::vector<Sweeper> list;          // of this frame, by body
    std::vector<std::uint32_t> ofBody;  // its place there, or kNone
};

}  // namespace hashphase
