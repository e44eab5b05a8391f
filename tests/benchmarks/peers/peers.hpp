// SPDX-License-Identifier: Zlib
#pragma once

// Broadphases of other libraries, one library a file. A library that was not found when this was
// built has no contestants.
//
// Same for all   Each is handed exactly the boxes of the scene, told only of those that changed where
//                it can make use of that, and writes its pairs to a list: that is its complete set.

#include <broadphase/parallel_for.hpp>
#include <tests/benchmarks/contestant.hpp>
#include <tests/benchmarks/crowd.hpp>

#include <optional>

namespace hashphase::benchmarks {

#ifdef HASHPHASE_BENCHMARKS_CGAL_PACKAGE
[[nodiscard]] std::vector<ContestantKind> cgalKinds();
#else
inline std::vector<ContestantKind> cgalKinds() {
    return {};
}
#endif
#ifdef HASHPHASE_BENCHMARKS_FCL_PACKAGE
[[nodiscard]] std::vector<ContestantKind> fclKinds();
#else
inline std::vector<ContestantKind> fclKinds() {
    return {};
}
#endif
#ifdef HASHPHASE_BENCHMARKS_ODE_PACKAGE
[[nodiscard]] std::vector<ContestantKind> odeKinds();
#else
inline std::vector<ContestantKind> odeKinds() {
    return {};
}
#endif
#ifdef HASHPHASE_BENCHMARKS_JOLT_PACKAGE
[[nodiscard]] std::vector<ContestantKind> joltKinds();
#else
inline std::vector<ContestantKind> joltKinds() {
    return {};
}
#endif
#ifdef HASHPHASE_BENCHMARKS_PHYSX_PACKAGE
[[nodiscard]] std::vector<ContestantKind> physxKinds();
#else
inline std::vector<ContestantKind> physxKinds() {
    return {};
}
#endif
#ifdef HASHPHASE_BENCHMARKS_NANOFLANN_PACKAGE
[[nodiscard]] std::vector<CrowdKind> nanoflannKinds();  // for crowds
#else
inline std::vector<CrowdKind> nanoflannKinds() {
    return {};
}
#endif

// Ours, on the threads of oneTBB, and loops on them.
#ifdef HASHPHASE_BENCHMARKS_TBB_PACKAGE
[[nodiscard]] std::vector<ContestantKind> threadedKinds();
[[nodiscard]] std::optional<ParallelFor> threadedLoop();
#else
inline std::vector<ContestantKind> threadedKinds() {
    return {};
}
inline std::optional<ParallelFor> threadedLoop() {
    return std::nullopt;
}
#endif

}  // namespace hashphase::benchmarks
