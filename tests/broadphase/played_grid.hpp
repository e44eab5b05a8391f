// SPDX-License-Identifier: Zlib
#pragma once

// A grid, its pairs and its sweeps at play, and all that they answer: for snapshots of them.

#include <broadphase/grid_snapshot.hpp>

#include <broadphase/collectors.hpp>
#include <broadphase/regions.hpp>
#include <broadphase/sweeps.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/random.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

namespace hashphase::test {

/// All that calls have answered, as numbers.
using Log = std::vector<std::uint64_t>;

inline void note(Log& log, ProxyId id) {
    log.push_back(std::uint64_t{id.index} << 32 | id.generation);
}
inline void note(Log& log, const PairChanges& changes) {
    for (const auto& list : {changes.born, changes.died}) {
        log.push_back(list.size());
        for (const ProxyPair& pair : list) {
            note(log, pair.first);
            note(log, pair.second);
        }
    }
}
inline void note(Log& log, const QueryCost& cost) {
    log.push_back(cost.boxesTested);
    log.push_back(cost.hits);
}

/// What is played: how many proxies, how they move, and what else happens to them.
struct Play {
    std::string name;
    std::uint32_t count = 0;
    double moving = 1;    // share of the proxies that move in a frame
    double step = 0.5;    // [m]
    double extent = 12;   // [m]
    double refused = 0;   // share of pairs that the filter refuses
    double sweeping = 0;  // share of moves that are sweeps
    double grouping = 0;  // share of moves that set groups
    bool hasPairs = true;
    bool hasRays = false;
    GridConfig config{};

    /// GoogleTest would print what lies between the members, too.
    friend void PrintTo(const Play& play, std::ostream* out) { *out << play.name; }
};

template <class Scalar>
class PlayedGrid {
public:
    PlayedGrid(const Play& play, std::uint64_t seed)
        : play_(play), random_(seed), grid(play.config), sweeps(grid) {
        if (play.hasPairs) {
            pairs = std::make_unique<Pairs<Scalar>>(grid, &sweeps);
        }
        for (std::uint32_t i = 0; i < play_.count; ++i) {
            add();
        }
    }

    /// Frames that depend on the state and on the seed alone.
    void play(std::uint64_t seed, int frames, Log& log) {
        random_ = Random(seed);
        for (int frame = 0; frame < frames; ++frame) {
            change(log);
            ask(log);
            if (random_.chance(0.9)) {
                update(log);
            }
            if (random_.chance(0.3)) {
                change(log);
            }
        }
    }

    void update(Log& log) {
        if (pairs == nullptr) {
            const UpdateCost cost = grid.update();
            if (notesCosts) {
                log.insert(log.end(), {cost.changed, cost.filed, cost.resting, cost.largestCell});
            }
            return;
        }
        note(log, pairs->update(filter()));
        const PairCost& cost = pairs->lastCost();
        log.push_back(pairs->count());
        if (notesCosts) {
            log.insert(log.end(), {cost.boxesTested, cost.pairsWatched, cost.grid.filed,
                                   cost.grid.resting, pairs->refusedCount()});
        }
        EXPECT_EQ(pairs->validate(), "");
        EXPECT_EQ(sweeps.validate(), "");
    }

    /// The grid, and what this program knows of it.
    struct Saved {
        GridSnapshot<Scalar> snapshot;
        std::vector<ProxyId> ids;
    };
    void save(Saved& saved) {
        saved.ids = ids_;
        pairs != nullptr ? saved.snapshot.save(*pairs) : saved.snapshot.save(grid);
    }
    void restore(const Saved& saved) {
        pairs != nullptr ? saved.snapshot.restore(*pairs) : saved.snapshot.restore(grid);
        ids_ = saved.ids;
    }
    void forgetAll() {
        pairs != nullptr ? pairs->clear() : grid.clear();
        ids_.clear();
    }

private:
    auto filter() {
        return [this](ProxyId a, ProxyId b) {
            const std::uint32_t key = (a.index * 2654435761U) ^ (b.index * 40503U);
            return (key >> 8) % 1000 >= play_.refused * 1000;
        };
    }
    void add() {
        const Vector3<double> middle = random_.pointIn(-play_.extent, play_.extent);
        const Vector3<double> half = random_.pointIn(0.2, random_.chance(0.02) ? 6 : 0.8);
        const auto mobility = random_.chance(0.1) ? Mobility::resting : Mobility::mobile;
        ids_.push_back(grid.add(boxAround<Scalar>(middle, half), mobility));
    }
    [[nodiscard]] ProxyId any() {
        return ids_[random_.below(static_cast<std::uint32_t>(ids_.size()))];
    }
    void change(Log& log) {
        const auto moves =
            static_cast<std::uint32_t>(play_.moving * static_cast<double>(ids_.size()));
        for (std::uint32_t i = 0; i < moves; ++i) {
            const ProxyId id = any();
            if (random_.chance(play_.sweeping)) {
                sweeps.set(id, random_.pointIn(-4, 4).template cast<Scalar>());
            } else if (random_.chance(play_.grouping)) {
                grid.setGroups(id, {1U << random_.below(4), ~(1U << random_.below(4))});
            } else if (random_.chance(0.005)) {
                grid.move(id, hostileBox<Scalar>(random_));
            } else {
                grid.move(id, shifted<Scalar>(random_, grid.box(id), play_.step));
            }
        }
        while (random_.chance(0.5) && ids_.size() > play_.count / 2) {
            const std::uint32_t victim = random_.below(static_cast<std::uint32_t>(ids_.size()));
            grid.remove(ids_[victim]);
            ids_[victim] = ids_.back();
            ids_.pop_back();
        }
        while (random_.chance(0.5)) {
            add();
            note(log, ids_.back());
        }
        if (pairs != nullptr && random_.chance(0.3)) {
            note(log, pairs->findPairsNow(any(), filter()));
        }
        if (pairs != nullptr && random_.chance(0.2)) {
            note(log, pairs->refilter(any(), filter()));
        }
        if (random_.chance(0.03)) {
            log.push_back(grid.shiftOrigin(random_.pointIn(-3, 3).template cast<Scalar>()));
        }
        log.insert(log.end(), {grid.size(), grid.indexLimit(), grid.nanCount()});
    }
    void ask(Log& log) {
        const auto collect = [&](const auto& region) {
            std::vector<ProxyId> found;
            CollectAll all(found);
            const QueryCost cost = grid.visit(region, all);
            if (notesCosts) {
                note(log, cost);
            } else {
                std::sort(found.begin(), found.end());
            }
            for (const ProxyId id : found) {  // in their order
                note(log, id);
            }
        };
        const auto draw = boxesIn<Scalar>(-play_.extent, play_.extent, 0.5, 4);
        for (std::uint32_t i = random_.below(8); i-- > 0;) {
            collect(BoxRegion<Scalar>{draw(random_)});
        }
        if (play_.hasRays && random_.chance(0.3)) {
            grid.expectRays(1000);
        }
        for (std::uint32_t i = play_.hasRays ? 4 : 0; i-- > 0;) {
            const Vector3<double> from = random_.pointIn(-20, 20);
            const Vector3<double> to = random_.pointIn(-20, 20);
            collect(RayRegion<Scalar>(from.template cast<Scalar>(), to.template cast<Scalar>()));
        }
        if (notesCosts) {
            log.push_back(grid.filingCount());
        }
    }

    Play play_;
    Random random_;
    std::vector<ProxyId> ids_;

public:
    bool notesCosts = true;  // and the order in which queries find proxies
    Grid<Scalar> grid;
    Sweeps<Scalar> sweeps;
    std::unique_ptr<Pairs<Scalar>> pairs;
};

inline std::vector<Play> plays() {
    return {
        {"Few", 12},
        {"AllMove", 300},
        {"SomeMove", 600, 0.05},
        {"Tremble", 400, 1, 0.004},
        {"TrembleAndTravel", 400, 0.5, 0.004, 12, 0.1, 0.02},
        {"FilterRefuses", 300, 0.5, 0.5, 12, 0.4},
        {"FilterRefusesNearlyAllOfACrowd", 500, 0.2, 0.1, 1, 0.99},
        {"Sweeps", 300, 0.5, 0.5, 12, 0.2, 0.2},
        {"Groups", 300, 0.5, 0.5, 12, 0.2, 0.05, 0.2},
        {"WithoutPairs", 500, 0.1, 0.5, 12, 0, 0, 0, false, true},
        {"Rays", 800, 0.02, 0.5, 12, 0, 0, 0, true, true},
        {"FixedCells", 300, 0.5, 0.5, 12, 0.2, 0.1, 0, true, false, {.cellSize = 2}},
        {"FixedSlack", 300, 0.5, 0.02, 12, 0.2, 0, 0, true, true, {.slack = 0.05}},
    };
}

/// A world of the play, two states of it, and what the second one answers.
struct BetweenTwoStates {
    BetweenTwoStates() : world({"Any", 200, 0.5, 0.5, 12, 0.3, 0.1, 0.1}, 3) {
        Log log;
        world.play(1, 20, log);
        world.save(before);
        world.play(2, 20, log);
        world.save(after);
    }
    [[nodiscard]] Log answers() {
        Log log;
        world.play(9, 3, log);
        return log;
    }
    PlayedGrid<float> world;
    PlayedGrid<float>::Saved before;
    PlayedGrid<float>::Saved after;
};

}  // namespace hashphase::test
