// SPDX-License-Identifier: Zlib
#include <demos/paper/phase_method.hpp>

#include <demos/paper/phase_makers.hpp>

#include <numeric>
#include <utility>

namespace hashphase::demos {

Subjects Subjects::all(std::uint32_t objects) {
    Subjects subjects;
    subjects.isOne_.assign(objects, 1);
    subjects.list_.resize(objects);
    std::iota(subjects.list_.begin(), subjects.list_.end(), 0U);
    return subjects;
}

Subjects Subjects::drawn(std::uint32_t objects, std::uint32_t count, std::uint64_t seed) {
    Random random(seed);
    Subjects subjects;
    subjects.isOne_.assign(objects, 0);
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto object = static_cast<std::uint32_t>(random.unit() * static_cast<float>(objects));
        subjects.isOne_[std::min(object, objects - 1)] = 1;
    }
    for (std::uint32_t i = 0; i < objects; ++i) {
        if (subjects.contains(i)) {
            subjects.list_.push_back(i);
        }
    }
    return subjects;
}

std::string_view nameOf(MethodKind kind) {
    switch (kind) {
        case MethodKind::unoptimized:
            return "un-optimized";
        case MethodKind::paperGrid:
            return "paper's grid";
        case MethodKind::hashphase:
            return "hashphase";
    }
    return {};
}

std::unique_ptr<PhaseMethod> bruteForce(Phase phase, Subjects subjects, float aiRadius) {
    switch (phase) {
        case Phase::collision:
            return bruteCollision(std::move(subjects));
        case Phase::visibility:
            return bruteVisibility(std::move(subjects));
        case Phase::ai:
            return bruteAi(std::move(subjects), aiRadius);
    }
    return nullptr;
}

MethodSpec methodSpec(Phase phase, MethodKind kind, std::optional<double> cellSize,
                      float aiRadius) {
    MethodSpec spec{kind, cellSize, {}};
    const double size = cellSize.value_or(0);
    const auto cell = static_cast<float>(size);
    if (kind == MethodKind::unoptimized) {
        spec.make = [phase, aiRadius](const TestBed& bed) {
            return bruteForce(phase, Subjects::all(bed.objects()), aiRadius);
        };
        return spec;
    }
    const bool isPaper = kind == MethodKind::paperGrid;
    switch (phase) {
        case Phase::collision:
            spec.make = [=](const TestBed& bed) {
                return isPaper ? paperCollision(bed, cell) : hashCollision(bed, size);
            };
            break;
        case Phase::visibility:
            spec.make = [=](const TestBed& bed) {
                return isPaper ? paperVisibility(bed, cell) : hashVisibility(bed, size);
            };
            break;
        case Phase::ai:
            spec.make = [=](const TestBed& bed) {
                return isPaper ? paperAi(bed, cell, aiRadius) : hashAi(bed, size, aiRadius);
            };
            break;
    }
    return spec;
}

std::vector<MethodSpec> figureMethods(Phase phase, std::uint32_t objects, float aiRadius) {
    std::vector<MethodSpec> specs;
    if (objects <= kMostBruteForced) {
        specs.push_back(methodSpec(phase, MethodKind::unoptimized, std::nullopt, aiRadius));
    }
    for (const double cellSize : kPrintedCellSizes) {
        specs.push_back(methodSpec(phase, MethodKind::paperGrid, cellSize, aiRadius));
        specs.push_back(methodSpec(phase, MethodKind::hashphase, cellSize, aiRadius));
    }
    specs.push_back(methodSpec(phase, MethodKind::hashphase, std::nullopt, aiRadius));
    return specs;
}

}  // namespace hashphase::demos
