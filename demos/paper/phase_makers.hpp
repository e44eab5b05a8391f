// SPDX-License-Identifier: Zlib
#pragma once

// The methods, phase by phase. Those of hashphase choose their cells where the size is 0.

#include <demos/paper/phase_method.hpp>

namespace hashphase::demos {

[[nodiscard]] std::unique_ptr<PhaseMethod> bruteCollision(Subjects subjects);
[[nodiscard]] std::unique_ptr<PhaseMethod> paperCollision(const TestBed& bed, float cellSize);
[[nodiscard]] std::unique_ptr<PhaseMethod> hashCollision(const TestBed& bed, double cellSize);

[[nodiscard]] std::unique_ptr<PhaseMethod> bruteVisibility(Subjects subjects);
[[nodiscard]] std::unique_ptr<PhaseMethod> paperVisibility(const TestBed& bed, float cellSize);
[[nodiscard]] std::unique_ptr<PhaseMethod> hashVisibility(const TestBed& bed, double cellSize);

[[nodiscard]] std::unique_ptr<PhaseMethod> bruteAi(Subjects subjects, float radius);
[[nodiscard]] std::unique_ptr<PhaseMethod> paperAi(const TestBed& bed, float cellSize,
                                                   float radius);
[[nodiscard]] std::unique_ptr<PhaseMethod> hashAi(const TestBed& bed, double cellSize,
                                                  float radius);

}  // namespace hashphase::demos
