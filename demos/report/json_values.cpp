// SPDX-License-Identifier: Zlib
#include <demos/report/json_values.hpp>

#include <cmath>

namespace hashphase::demos {

Json orNull(const std::string& text) {
    return text.empty() ? Json(nullptr) : Json(text);
}

std::string textOf(const Json& json) {
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

Json valueJson(const Value& value) {
    if (const std::string* text = std::get_if<std::string>(&value)) {
        return *text;
    }
    const double* number = std::get_if<double>(&value);
    return number != nullptr && std::isfinite(*number) ? Json(*number) : Json(nullptr);
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
            {"programFlags", orNull(provenance.programFlags)},
            {"optimised", provenance.optimised},
            {"assertions", provenance.hasAssertions},
            {"buildType", orNull(provenance.buildType)},
            {"forMeasuring", provenance.isForMeasuring},
            {"instructionSet", provenance.instructionSet},
            {"cpu", provenance.cpu},
            {"cores", provenance.cores},
            {"loadAverage", orNull(provenance.loadAverage)},
            {"commandLine", provenance.commandLine}};
}

}  // namespace hashphase::demos
