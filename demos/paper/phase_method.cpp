// SPDX-License-Identifier: Zlib
#include <demos/paper/phase_method.hpp>

#include <algorithm>
#include <utility>

namespace hashphase::demos {

std::string_view nameOf(Phase phase) {
    constexpr std::array<std::string_view, 3> kNames{"collision", "visibility", "AI"};
    return kNames[static_cast<std::size_t>(phase)];
}

std::string_view nameOf(MethodKind kind) {
    constexpr std::array<std::string_view, 3> kNames{"un-optimized", "paper's grid", "hashphase"};
    return kNames[static_cast<std::size_t>(kind)];
}

Subjects::Subjects(std::vector<char> isOne) : isOne_(std::move(isOne)) {
    for (std::uint32_t i = 0; i < isOne_.size(); ++i) {
        if (contains(i)) {
            list_.push_back(i);
        }
    }
}

Subjects Subjects::all(std::uint32_t objects) {
    return Subjects(std::vector<char>(objects, 1));
}

Subjects Subjects::drawn(std::uint32_t objects, std::uint32_t count, std::uint64_t seed) {
    Random random(seed);
    std::vector<char> isOne(objects, 0);
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto object = static_cast<std::uint32_t>(random.unit() * static_cast<float>(objects));
        isOne[std::min(object, objects - 1)] = 1;
    }
    return Subjects(std::move(isOne));
}

std::unique_ptr<PhaseMethod> makeMethod(const MethodPlan& plan, const TestBed& bed,
                                        Subjects subjects) {
    constexpr std::array<MakeMethod*, 3> kMakers{makeCollisionMethod, makeVisibilityMethod,
                                                 makeAiMethod};
    return kMakers[static_cast<std::size_t>(plan.phase)](plan, bed, std::move(subjects));
}

std::vector<MethodSpec> figureMethods(std::uint32_t objects) {
    std::vector<MethodSpec> specs;
    if (objects <= kMostBruteForced) {
        specs.push_back({MethodKind::unoptimized, std::nullopt});
    }
    for (const double cellSize : kPrintedCellSizes) {
        specs.push_back({MethodKind::paperGrid, cellSize});
        specs.push_back({MethodKind::hashphase, cellSize});
    }
    specs.push_back({MethodKind::hashphase, std::nullopt});
    return specs;
}

}  // namespace hashphase::demos
