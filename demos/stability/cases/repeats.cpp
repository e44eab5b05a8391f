// SPDX-License-Identifier: Zlib
//
// The same answer with all instructions, on any number of threads, in any order.

#include <demos/stability/cases/cases.hpp>

#include <broadphase/convex_region.hpp>
#include <broadphase/radius_search.hpp>
#include <broadphase/simd/kernels.hpp>
#include <broadphase/sweeps.hpp>
#include <demos/scenes/result_hash.hpp>
#include <demos/stability/run_together.hpp>

#include <array>
#include <map>
#include <numeric>

namespace hashphase::demos {
namespace {

using detail::InstructionSet;

/// A ParallelFor on threads of its own.
class OnThreads {
public:
    explicit OnThreads(std::size_t count) : count_(count) {}

    /// Whether all threads had work in some loop of every grain.
    [[nodiscard]] bool wereAllBusy() const {
        return !mostParts_.empty() &&
               std::all_of(mostParts_.begin(), mostParts_.end(),
                           [this](const auto& each) { return each.second == count_; });
    }

    void operator()(std::size_t count, std::size_t grain, LoopBody body) {
        const std::size_t parts =
            std::min(count_, (count + grain - 1) / std::max<std::size_t>(grain, 1));
        std::size_t& most = mostParts_[grain];
        most = std::max(most, parts);
        runTogether(parts, [=](std::size_t part) {
            body(count * part / parts, count * (part + 1) / parts);
        });
    }

private:
    std::size_t count_;
    std::map<std::size_t, std::size_t> mostParts_;  // by grain
};

// Boxes of many sizes, on borders and beside them.
template <class Scalar>
std::vector<Aabb<Scalar>> variedBoxes(std::size_t count, std::uint64_t seed) {
    const float side = 1.2F * std::cbrt(static_cast<float>(count));
    std::vector<Aabb<Scalar>> boxes;
    for (const Aabb<float>& box : scatteredCubes<float>(count, side, 0.05F, 1.5F, seed)) {
        boxes.push_back(box.cast<Scalar>());
    }
    for (std::size_t i = 0; i < count; i += 3) {
        const Vector3<Scalar> low = boxes[i].min().array().floor();
        boxes[i] = {low, low + boxes[i].sizes()};
    }
    return boxes;
}

// All that pairs, sweeps, rays, volumes and crowds say over some frames.
template <class Scalar>
std::uint64_t hashOfAll(std::size_t count, std::uint64_t seed, ParallelFor parallelFor) {
    ResultHash hash;
    Grid<Scalar> grid;
    Sweeps<Scalar> sweeps(grid);
    Pairs<Scalar> pairs(grid, &sweeps);
    std::vector<Aabb<Scalar>> boxes = variedBoxes<Scalar>(count, seed);
    std::vector<ProxyId> ids;
    for (const Aabb<Scalar>& box : boxes) {
        ids.push_back(grid.add(box));
    }
    const auto all = [](ProxyId, ProxyId) { return true; };
    Random random(seed);
    for (int frame = 0; frame < 4; ++frame) {
        for (std::size_t i = 0; i < count; i += 2) {
            const Vector3<Scalar> by(random.between(-0.2F, 0.2F), random.between(-0.2F, 0.2F), 0);
            boxes[i].translate(by);
            grid.move(ids[i], boxes[i]);
            if (i % 20 == 0) {
                sweeps.set(ids[i], 40 * by);
            }
        }
        const PairChanges changes = pairs.update(all, parallelFor);
        hash.addAll(changes.born);
        hash.addAll(changes.died);
    }
    CollectClosest<Scalar> closest;
    grid.visit(RayRegion<Scalar>(boxes[0].min(), boxes[1].max()), closest);
    hash.add(closest.found().index);
    std::vector<std::uint64_t> bits;
    CollectBits seen(bits);
    const std::array<Eigen::Hyperplane<Scalar, 3>, 3> planes{
        {{Vector3<Scalar>(1, 2, 3), Scalar(-1)},
         {Vector3<Scalar>(-2, 1, 0), Scalar(4)},
         {Vector3<Scalar>(0, -1, 1), Scalar(2)}}};
    grid.visit(ConvexRegion<Scalar>(planes), seen);
    for (const std::uint64_t word : bits) {
        hash.add(word);
    }
    RadiusSearch<Scalar> search;
    search.take(grid, 1, acceptAll, parallelFor);
    std::vector<std::uint32_t> counts(search.size());
    search.count(counts, parallelFor);
    for (std::uint32_t agent = 0; agent < search.size(); ++agent) {
        hash.add(std::uint64_t{search.id(agent).index} << 32 | counts[agent]);
    }
    return hash.value();
}

constexpr auto allInstructions = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    if (!run.isOurs) {
        return;
    }
    std::string tried;
    const std::size_t count = run.template quickOrFull<std::size_t>(1500, 10'000);
    const InstructionSet before = detail::instructionSet();
    std::uint64_t expected = 0;
    for (const InstructionSet set : detail::kInstructionSets) {
        if (!detail::isAvailable(set)) {
            continue;
        }
        detail::useInstructionSet(set);
        const std::uint64_t hash = hashOfAll<Scalar>(count, run.seed, serialFor);
        expected = tried.empty() ? hash : expected;
        run.expect(hash == expected, "the answers equal the answers of scalar code");
        judgePairs(run, variedBoxes<Scalar>(1000, run.seed));
        tried += (tried.empty() ? "" : ", ") + std::string(detail::nameOf(set));
    }
    detail::useInstructionSet(before);
    run.note("Tested here: " + tried + ".");
};

/// The boxes in another order, and back by what they were called before.
template <class Scalar>
Keys pairsInOrder(CaseRun<Scalar>& run, const Boxes<Scalar>& boxes, const Objects& order) {
    Boxes<Scalar> permuted;
    for (const std::uint32_t object : order) {
        permuted.push_back(boxes[object]);
    }
    PairScene<Scalar> scene(run, permuted);
    for (int frame = 0; frame < 4; ++frame) {
        for (std::uint32_t i = 0; i < scene.size(); ++i) {
            const Scalar by = frame % 2 == 0 ? Scalar(0.125) : Scalar(-0.125);
            scene.move(i, scene.boxes()[i].translated(Vector3<Scalar>(by, 0, 0)));
        }
        scene.findPairs();
    }
    Keys pairs;
    for (const PairKey pair : scene.reported()) {
        pairs.push_back(pairKey(order[firstOf(pair)], order[secondOf(pair)]));
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

constexpr auto anyOrder = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    const Boxes<Scalar> boxes = variedBoxes<Scalar>(1000, run.seed);
    Objects order(boxes.size());
    std::iota(order.begin(), order.end(), 0U);
    const Keys expected = pairsInOrder(run, boxes, order);
    Random random(run.seed);
    for (int i = 0; i < 4; ++i) {
        for (std::size_t k = order.size(); k > 1; --k) {
            std::swap(order[k - 1], order[indexBelow(random, static_cast<std::uint32_t>(k))]);
        }
        run.compare(pairsInOrder(run, boxes, order), expected);
    }
    if (!run.isOurs) {
        return;
    }
    constexpr std::size_t kCount = 70'000;
    const std::uint64_t alone = hashOfAll<Scalar>(kCount, run.seed, serialFor);
    for (const std::size_t threads : {1U, 2U, 3U, 5U, 8U, 16U}) {
        // Loops are cut in the same way in both precisions.
        if (std::is_same_v<Scalar, double> && threads != 5 && threads != 16) {
            continue;
        }
        OnThreads parallel(threads);
        run.expect(hashOfAll<Scalar>(kCount, run.seed, parallel) == alone,
                   "the answers are the same on any number of threads");
        run.expect(parallel.wereAllBusy(), "every thread has work");
    }
};

constexpr HardCase kRepeatCases[] = {
    {"H38", "all instruction sets",
     "pairs and sweeps of 10,000 boxes (--quick: 1,500) over four frames, then a ray, a convex "
     "region and a radius search; in both precisions; with each instruction set that this "
     "processor has",
     "the same answers with all instruction sets, bit for bit", allInstructions},
    {"H39", "any order, any number of threads",
     "1,000 boxes, created in five orders, and moved; for hashphase also the work of H38 on 70,000 "
     "boxes, with 1, 2, 3, 5, 8 and 16 threads",
     "the same sorted pairs in any creation order; the same answers on any number of threads",
     anyOrder},
};

}  // namespace

std::span<const HardCase> repeatCases() {
    return kRepeatCases;
}

}  // namespace hashphase::demos
