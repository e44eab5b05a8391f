// SPDX-License-Identifier: Zlib
#pragma once

// The price list as text, JSON, CSV and a page with charts.

#include <demos/effects/effects_prices.hpp>
#include <demos/report/page.hpp>

#include <iosfwd>

namespace hashphase::demos {

struct EffectsReport {
    EffectPrices prices;
    std::string name;  // of the scene
    Provenance provenance;
};

void printReport(const EffectsReport& report, std::ostream& out);

/// Every variant with its times, counters and bytes, and the prices.
void writeJson(const EffectsReport& report, std::ostream& out);

/// A row for each variant: times, counters a frame, bytes.
void writeCsv(const EffectsReport& report, std::ostream& out);

/// The price list as a page with charts.
[[nodiscard]] Page pageOf(const EffectsReport& report);

/// Whether all checks hold.
[[nodiscard]] bool allHold(const EffectsReport& report);

}  // namespace hashphase::demos
