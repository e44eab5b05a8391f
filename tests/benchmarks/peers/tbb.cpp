// SPDX-License-Identifier: Zlib

// Ours, its loops on all threads of oneTBB.

#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <integration/tbb/tbb_parallel_for.hpp>
#include <tests/benchmarks/peers/peers.hpp>

#include <limits>

namespace hashphase::benchmarks {

std::vector<ContestantKind> threadedKinds() {
    static const demos::BroadphaseKind bullet{
        "hash-threads",
        "hashphase::SpatialHashBroadphase, tbbFor",
        "the spatial hash on all threads of oneTBB (in the case 'threads')",
        true,
        std::numeric_limits<std::size_t>::max(),
        false,
        [](const demos::BroadphaseNeeds&) -> std::unique_ptr<btBroadphaseInterface> {
            SpatialHashConfig config;
            config.parallelFor = tbbFor;
            return std::make_unique<SpatialHashBroadphase>(config);
        }};
    ContestantKind kind = bulletKind(bullet, true);
    kind.package = std::string("this build, ") + HASHPHASE_BENCHMARKS_TBB_PACKAGE;
    kind.onThreads = true;
    return {kind};
}

std::optional<ParallelFor> threadedLoop() {
    return ParallelFor(tbbFor);
}

}  // namespace hashphase::benchmarks
