// SPDX-License-Identifier: Zlib
#pragma once

// What all JSON reports have in common. What was not measured is null, never NaN.

#include <demos/report/data_table.hpp>
#include <demos/report/provenance.hpp>

#include <nlohmann/json.hpp>

#include <optional>
#include <string>

namespace hashphase::demos {

using Json = nlohmann::ordered_json;
struct Chart;

template <class Value>
[[nodiscard]] Json orNull(const std::optional<Value>& value) {
    return value ? Json(*value) : Json(nullptr);
}
[[nodiscard]] Json orNull(const std::string& text);

/// Indented, with a line break at the end. Names of files need not be UTF-8: what is not, is replaced.
[[nodiscard]] std::string textOf(const Json& json);

[[nodiscard]] Json valueJson(const Value& value);

/// The rows as an array of objects. A column "a.b" is the member `b` of a member `a`, which is null where
/// all its members are; one "a?" is a truth, and one "a{}" JSON as text.
[[nodiscard]] Json rowsJson(const DataTable& table);

/// {"columns": [{"name": .., "title": ..}], "rows": [[..]]}
[[nodiscard]] Json tableJson(const DataTable& table);

/// All of the chart, as charts.js draws it.
[[nodiscard]] Json chartJson(const Chart& chart);

/// JSON for within a <script>: nothing in it can end the script.
[[nodiscard]] std::string jsonInScript(const Json& json);

[[nodiscard]] Json provenanceJson(const Provenance& provenance);

}  // namespace hashphase::demos
