// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/bullet_contestant.hpp>
#include <tests/benchmarks/contestant.hpp>
#include <tests/benchmarks/grid_contestant.hpp>
#include <tests/benchmarks/peers/peers.hpp>

#include <algorithm>

namespace hashphase::benchmarks {
namespace {

std::vector<ContestantKind> allKinds() {
    std::vector<ContestantKind> kinds = bulletKinds();
    kinds.insert(kinds.begin() + 2, gridKind("grid", {}));
    for (const auto& peersOf : {threadedKinds, cgalKinds, fclKinds, odeKinds}) {
        for (ContestantKind& kind : peersOf()) {
            kinds.push_back(std::move(kind));
        }
    }
    return kinds;
}

}  // namespace

const std::vector<ContestantKind>& contestantKinds() {
    static const std::vector<ContestantKind> kinds = allKinds();
    return kinds;
}

const ContestantKind& contestantKind(std::string_view name) {
    const std::vector<ContestantKind>& kinds = contestantKinds();
    return *std::find_if(kinds.begin(), kinds.end(),
                         [name](const ContestantKind& kind) { return kind.name == name; });
}

}  // namespace hashphase::benchmarks
