// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/accuracy/accuracy.hpp>
#include <demos/report/page.hpp>

namespace hashphase::demos {

/// What the experiments found, as a page: the verdict, what to choose, experiment by experiment what
/// was found, and where.
[[nodiscard]] Page pageOf(const AccuracyReport& report);

}  // namespace hashphase::demos
