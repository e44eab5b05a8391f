// SPDX-License-Identifier: Zlib
#pragma once

// The price list as text, JSON, CSV and a page with charts.

#include <demos/effects/effects_prices.hpp>
#include <demos/report/page.hpp>

#include <iosfwd>

namespace hashphase::demos {

void printReport(const EffectPrices& prices, std::ostream& out);

/// Every variant with its times, counters and bytes, and the prices.
void writeJson(const EffectPrices& prices, std::ostream& out);

/// A row for each variant: times, counters a frame, bytes.
void writeCsv(const EffectPrices& prices, std::ostream& out);

/// The price list as a page with charts.
[[nodiscard]] Page pageOf(const EffectPrices& prices);

/// Whether all checks hold.
[[nodiscard]] bool allHold(const EffectPrices& prices);

}  // namespace hashphase::demos
