// SPDX-License-Identifier: Zlib
//
// Many at one place.

#include <demos/stability/cases/cases.hpp>

#include <broadphase/radius_search.hpp>
#include <demos/console/format.hpp>
#include <demos/scenes/random.hpp>
#include <demos/stability/isolation.hpp>
#include <demos/stability/pair_scene.hpp>

#include <algorithm>
#include <array>
#include <fstream>
#include <new>

#include <sys/resource.h>
#include <unistd.h>

namespace hashphase::demos {
namespace {

using Point = Vector3<float>;

// What sorting along an axis and testing what overlaps there tests.
double testsAlongAnAxis(const Boxes& boxes) {
    const LimitPause pause;
    std::vector<float> starts;
    for (const Aabb<float>& box : boxes) {
        starts.push_back(box.min().x());
    }
    std::sort(starts.begin(), starts.end());
    double tests = 0;
    for (const Aabb<float>& box : boxes) {
        const auto first = std::upper_bound(starts.begin(), starts.end(), box.min().x());
        tests += static_cast<double>(std::upper_bound(first, starts.end(), box.max().x()) - first);
    }
    return tests;
}

CaseOutcome oneCell(const CaseContext& context) {
    const std::size_t count = context.quickOrFull<std::size_t>(20'000, 200'000);
    const Boxes boxes = scatteredCubes(count, 0.98F, 0.008F, 0.008F, context.seed);
    CaseTally tally;
    PairScene scene(context, boxes, {.cellSize = 1});
    scene.judge(tally);
    if (const SpatialHashBroadphase* hash = scene.hash()) {
        tally.addCost(static_cast<double>(hash->lastCost().boxesTested) / testsAlongAnAxis(boxes),
                      1.25);
        tally.note("Cost: boxes tested, by those that sorting along an axis leaves.");
        tally.expect(hash->lastCost().grid.largestCell >= count / 2, "the crowd is told");
    }
    return tally.outcome();
}

// Bytes that ours holds for each pair of so many identical boxes.
double bytesPerPair(const CaseContext& context, CaseTally& tally, std::size_t count) {
    PairScene scene(context, Boxes(count, cubeAt({1, 2, 3}, 1)));
    scene.judge(tally);
    scene.judge(tally);
    const SpatialHashBroadphase* hash = scene.hash();
    return hash == nullptr ? 1
                           : static_cast<double>(hash->memoryBytes()) /
                                 static_cast<double>(scene.reported().size());
}

CaseOutcome allTheSame(const CaseContext& context) {
    const std::size_t count = context.quickOrFull<std::size_t>(600, 2000);
    CaseTally tally;
    const double many = bytesPerPair(context, tally, count);
    if (context.kind.ours) {
        tally.addCost(many / bytesPerPair(context, tally, count / 2), 2);
        tally.note("Cost: bytes held for each pair, " + fixed(many, 0) +
                   ", by those of half as many boxes.");
    }
    return tally.outcome();
}

// --- Counts beyond 32 bits ------------------------------------------------------------------------

// Sanitizers end a program that runs out of memory.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kCanRunOutOfMemory = false;
#elif defined(__has_feature)
constexpr bool kCanRunOutOfMemory =
    !__has_feature(address_sanitizer) && !__has_feature(thread_sanitizer);
#else
constexpr bool kCanRunOutOfMemory = true;
#endif

// While it lives, the process gets no more than so much memory beyond what it has.
class MemoryLimit {
public:
    explicit MemoryLimit(std::uint64_t more) {
        std::uint64_t pages = 0;
        std::ifstream("/proc/self/statm") >> pages;
        getrlimit(RLIMIT_AS, &before_);
        rlimit limit = before_;
        limit.rlim_cur = pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)) + more;
        setrlimit(RLIMIT_AS, &limit);
    }
    MemoryLimit(const MemoryLimit&) = delete;
    MemoryLimit& operator=(const MemoryLimit&) = delete;
    ~MemoryLimit() { setrlimit(RLIMIT_AS, &before_); }

private:
    rlimit before_{};
};

// Everybody is everybody's neighbour.
void judgeCounts(const CaseContext& context, CaseTally& tally) {
    const std::uint32_t count = context.quickOrFull(66'000U, 70'000U);
    Grid<float> grid;
    Random random(context.seed);
    for (std::uint32_t i = 0; i < count; ++i) {
        static_cast<void>(grid.add(
            cubeAt({random.between(0, 1), random.between(0, 1), random.between(0, 1)}, 0.1F)));
    }
    RadiusSearch<float> search;
    search.take(grid, 10);
    std::vector<std::uint32_t> counts(search.size());
    const QueryCost cost = search.count(counts);
    const std::uint64_t exact = std::uint64_t{count} * (count - 1);
    std::uint64_t sum = 0;
    for (const std::uint32_t each : counts) {
        sum += each;
    }
    tally.expect(sum == exact && cost.hits == exact, "all neighbours are counted");
}

CaseOutcome beyond32Bits(const CaseContext& context) {
    CaseTally tally;
    if (kCanRunOutOfMemory) {
        constexpr std::size_t kCount = 8000;  // 32 million pairs
        const Boxes together(kCount, cubeAt({0, 0, 0}, 1));
        Boxes apart;
        for (std::size_t i = 0; i < kCount; ++i) {
            apart.push_back(cubeAt({0.75F * static_cast<float>(i), 0, 0}, 1));
        }
        PairScene scene(context, apart);
        scene.judge(tally);
        bool isTold = false;
        {
            const MemoryLimit limit(64 << 20);
            try {
                scene.moveAll(together);
                scene.findPairs();
            } catch (const std::bad_alloc&) {
                isTold = true;
            }
        }
        tally.expect(isTold, "what does not fit is refused with std::bad_alloc");
        // Apart again, all goes on.
        scene.moveAll(apart);
        scene.judge(tally);
    } else {
        tally.note("Under a sanitizer memory cannot run out.");
    }
    if (context.kind.ours) {
        judgeCounts(context, tally);
    }
    return tally.outcome();
}

constexpr std::array kCrowdCases{
    HardCase{"H25", "100,000 in one cell",
             "200,000 (--quick: 20,000) cubes of 8 mm in a cubic metre, half of them in one cell",
             "exact pairs; no more work than sorting along an axis; the cost names the crowd",
             oneCell},
    HardCase{"H26", "2,000 at one place", "2,000 (--quick: 600) times the same cube of 1 m",
             "1,999,000 pairs, each once; memory in proportion to them", allTheSame},
    HardCase{"H45", "more than memory and 32 bits hold",
             "8,000 in a row, each touching the next, all moved to one place with 64 MiB of memory "
             "left for 32 million pairs, and back; 4.9e9 neighbours to be counted (--quick: 4.4e9)",
             "an error that the caller can catch, and exact pairs afterwards; counts that do not "
             "wrap",
             beyond32Bits},
};

}  // namespace

std::span<const HardCase> crowdCases() {
    return kCrowdCases;
}

}  // namespace hashphase::demos
