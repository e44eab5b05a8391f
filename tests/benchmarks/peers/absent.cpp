// SPDX-License-Identifier: Zlib

// Stands in for each library that was not found.

#include <tests/benchmarks/peers/peers.hpp>

namespace hashphase::benchmarks {

#ifndef HASHPHASE_BENCHMARKS_CGAL_PACKAGE
std::vector<ContestantKind> cgalKinds() {
    return {};
}
#endif

#ifndef HASHPHASE_BENCHMARKS_FCL_PACKAGE
std::vector<ContestantKind> fclKinds() {
    return {};
}
#endif

#ifndef HASHPHASE_BENCHMARKS_ODE_PACKAGE
std::vector<ContestantKind> odeKinds() {
    return {};
}
#endif

#ifndef HASHPHASE_BENCHMARKS_TBB_PACKAGE
std::vector<ContestantKind> threadedKinds() {
    return {};
}

std::optional<ParallelFor> threadedLoop() {
    return std::nullopt;
}
#endif

#ifndef HASHPHASE_BENCHMARKS_NANOFLANN_PACKAGE
std::vector<CrowdKind> nanoflannKinds() {
    return {};
}
#endif

}  // namespace hashphase::benchmarks
