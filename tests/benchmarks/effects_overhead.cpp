// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/effects_overhead.hpp>

#include <tests/benchmarks/effects_workload.hpp>

namespace hashphase::benchmarks {
namespace {

constexpr double kMostDeclared = 1.01;  // a scene without the other effects
constexpr double kMostNobody = 1.02;    // one whose bodies do not take part in them

std::optional<double> boundOf(std::string_view contestant) {
    return contestant == kDeclared ? std::optional(kMostDeclared)
           : contestant == kNobody ? std::optional(kMostNobody)
                                   : std::nullopt;
}

}  // namespace

std::vector<EffectsOverhead> effectsOverheads(const CaseResult& result) {
    std::vector<EffectsOverhead> overheads;
    const ContestantResult* byHand = result.find(kByHand);
    if (result.group != kEffectsGroup || byHand == nullptr) {
        return overheads;
    }
    for (const ContestantResult& contestant : result.contestants) {
        std::vector<double> ratios;
        for (std::size_t i = 0; i < contestant.frameMs.size() && &contestant != byHand; ++i) {
            ratios.push_back(contestant.frameMs[i] / byHand->frameMs[i]);
        }
        if (!ratios.empty()) {
            overheads.push_back({contestant.kind.name, demos::spreadOf(std::move(ratios)),
                                 boundOf(contestant.kind.name)});
        }
    }
    return overheads;
}

}  // namespace hashphase::benchmarks
