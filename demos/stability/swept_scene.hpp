// SPDX-License-Identifier: Zlib
#pragma once

// Boxes that move, and whether all that they touch on their way is found. Ours sweeps, in every mode;
// Bullet's broadphases are given the box around start and end, as m_useContinuous does.

#include <broadphase/sweeps.hpp>
#include <demos/stability/scene.hpp>

#include <array>
#include <utility>

namespace hashphase::demos {

/// Moving boxes, the first of which sweep; the others stand still.
template <class Scalar>
struct SweptScene {
    std::vector<MovingBox<Scalar>> objects;
    std::uint32_t movers = 0;
};

/// The pairs that touch at some time, of one mover at least.
template <class Scalar>
[[nodiscard]] Keys truthOf(const SweptScene<Scalar>& frame, const Lattice& lattice) {
    const LimitPause pause;
    Keys pairs;
    const auto count = static_cast<std::uint32_t>(frame.objects.size());
    for (std::uint32_t a = 0; a < frame.movers; ++a) {
        for (std::uint32_t b = a + 1; b < count; ++b) {
            if (lattice.meet(frame.objects[a], frame.objects[b])) {
                pairs.push_back(pairKey(a, b));
            }
        }
    }
    return pairs;
}

/// Those whose first object moves.
[[nodiscard]] inline Keys withMovers(const Keys& pairs, std::uint32_t movers) {
    Keys kept = pairs;
    std::erase_if(kept, [movers](PairKey pair) { return firstOf(pair) >= movers; });
    return kept;
}

/// What Sweeps and Pairs find: pairs of at least one mover, sorted; and what it cost.
template <class Scalar>
[[nodiscard]] std::pair<Keys, SweepCost> sweepOurs(const SweptScene<Scalar>& frame, Sweep sweep,
                                                   const GridConfig& config = {}) {
    Grid<Scalar> grid(config);
    Sweeps<Scalar> sweeps(grid);
    Pairs<Scalar> pairs(grid, &sweeps);
    for (std::uint32_t i = 0; i < frame.objects.size(); ++i) {
        const ProxyId id = grid.add(frame.objects[i].box);
        if (i < frame.movers) {
            sweeps.set(id, frame.objects[i].displacement, sweep);
        }
    }
    Keys found;
    for (const ProxyPair& pair : pairs.update().born) {
        found.push_back(pairKey(pair.first.index, pair.second.index));
    }
    return {withMovers(found, frame.movers), sweeps.lastCost()};
}

/// Of ours, in every mode; returns what each took, in tests.
template <class Scalar>
std::array<std::uint64_t, 3> judgeFrame(CaseRun<Scalar>& run, const SweptScene<Scalar>& frame,
                                        const Keys& exact, const GridConfig& config = {}) {
    std::array<std::uint64_t, 3> tests{};
    if (run.isOurs) {
        constexpr std::array kModes{Sweep::automatic, Sweep::box, Sweep::line};
        for (std::size_t i = 0; i < kModes.size(); ++i) {
            const auto [pairs, cost] = sweepOurs(frame, kModes[i], config);
            run.compare(pairs, exact);
            run.expect(cost.segments <= 40 * std::uint64_t{frame.movers},
                       "a path has at most 40 segments");
            tests[i] = cost.boxesTested + cost.contactsTested;
        }
        return tests;
    }
    Boxes<Scalar> boxes;
    for (const MovingBox<Scalar>& object : frame.objects) {
        boxes.push_back(object.box.merged(object.box.translated(object.displacement)));
    }
    PairScene<Scalar> scene(run, boxes);
    scene.findPairs();
    run.compare(withMovers(scene.reported(), frame.movers), exact);
    return tests;
}

template <class Scalar>
std::array<std::uint64_t, 3> judgeFrame(CaseRun<Scalar>& run, const SweptScene<Scalar>& frame,
                                        double unit, const GridConfig& config = {}) {
    return judgeFrame(run, frame, truthOf(frame, Lattice(unit)), config);
}

}  // namespace hashphase::demos
