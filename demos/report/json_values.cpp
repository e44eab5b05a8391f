// SPDX-License-Identifier: Zlib
#include <demos/report/json_values.hpp>

namespace hashphase::demos {

Json orNull(const std::string& text) {
    return text.empty() ? Json(nullptr) : Json(text);
}

Json spreadJson(const std::optional<Spread>& spread) {
    if (!spread) {
        return nullptr;
    }
    return {{"median", spread->median}, {"p5", spread->low}, {"p95", spread->high}};
}

Json provenanceJson(const Provenance& provenance) {
    return {{"hashphase", provenance.hashphaseVersion},
            {"bullet", provenance.bulletVersion},
            {"precision", provenance.precision},
            {"compiler", provenance.compiler},
            {"compilerFlags", orNull(provenance.compilerFlags)},
            {"optimised", provenance.optimised},
            {"cpu", provenance.cpu},
            {"cores", provenance.cores},
            {"loadAverage", orNull(provenance.loadAverage)},
            {"commandLine", provenance.commandLine}};
}

}  // namespace hashphase::demos
