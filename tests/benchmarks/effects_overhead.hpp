// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/report/statistics.hpp>
#include <tests/benchmarks/measurement.hpp>

#include <optional>
#include <string>
#include <vector>

namespace hashphase::benchmarks {

/// What a contestant took of the frame written by hand.
struct EffectsOverhead {
    std::string contestant;
    demos::Spread ratio;          // to by-hand in the same frame
    std::optional<double> bound;  // that it promises to keep; none for by-hand itself
    [[nodiscard]] bool holds() const noexcept { return !bound || ratio.median <= *bound; }
};

/// Of all but by-hand. Nothing for other cases, and of whom was not measured.
[[nodiscard]] std::vector<EffectsOverhead> effectsOverheads(const CaseResult& result);

}  // namespace hashphase::benchmarks
