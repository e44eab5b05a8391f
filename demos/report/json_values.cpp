// SPDX-License-Identifier: Zlib
#include <demos/report/json_values.hpp>

#include <demos/report/page.hpp>

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
    if (number == nullptr || !std::isfinite(*number)) {
        return nullptr;
    }
    return std::trunc(*number) == *number &&
                   std::abs(*number) <= static_cast<double>(kMostExactWhole)
               ? Json(static_cast<std::int64_t>(*number))
               : Json(*number);
}

Json rowsJson(const DataTable& table) {
    Json rows = Json::array();
    for (const std::vector<Value>& row : table.rows) {
        Json object = Json::object();
        for (std::size_t i = 0; i < row.size(); ++i) {
            std::string name = table.columns[i].name;
            Json value = valueJson(row[i]);
            if (name.ends_with('?')) {
                name.pop_back();
                value = value.is_null() ? value : Json(value != 0);
            } else if (name.ends_with("{}")) {
                name.resize(name.size() - 2);
                value = value.is_null() ? value : Json::parse(value.get<std::string>());
            }
            const std::size_t dot = name.find('.');
            if (dot == std::string::npos) {
                object[name] = std::move(value);
            } else if (Json& outer = object[name.substr(0, dot)]; !value.is_null()) {
                outer[name.substr(dot + 1)] = std::move(value);
            }
        }
        rows.push_back(std::move(object));
    }
    return rows;
}

Json tableJson(const DataTable& table) {
    Json columns = Json::array();
    for (const DataColumn& column : table.columns) {
        columns.push_back({{"name", column.name}, {"title", titleOf(column)}});
    }
    Json rows = Json::array();
    for (const std::vector<Value>& values : table.rows) {
        Json& row = rows.emplace_back(Json::array());
        for (const Value& value : values) {
            row.push_back(valueJson(value));
        }
    }
    return {{"columns", std::move(columns)}, {"rows", std::move(rows)}};
}

Json chartJson(const Chart& chart) {
    Json json{{"name", chart.name}, {"title", chart.title}, {"settings", chart.settings}};
    for (const auto& [key, words] : chart.drawn) {
        json[key] = words;
    }
    json["data"] = tableJson(chart.data);
    for (std::size_t i = 0; i < chart.data.columns.size(); ++i) {
        json["data"]["columns"][i]["digits"] = digitsOf(chart.data.columns[i]);
    }
    return json;
}

std::string jsonInScript(const Json& json) {
    std::string text;
    for (const char letter : json.dump(-1, ' ', false, Json::error_handler_t::replace)) {
        text += letter == '<' ? std::string("\\u003c") : std::string(1, letter);
    }
    return text;
}

Json provenanceJson(const Provenance& provenance) {
    return {{"date", provenance.date},
            {"hashphase", provenance.hashphaseVersion},
            {"commit", provenance.commit},
            {"bullet", provenance.bulletVersion},
            {"precision", provenance.precision},
            {"bulletThreads", provenance.hasBulletThreads},
            {"bulletProfileZones", provenance.hasBulletProfileZones},
            {"bulletPackage", orNull(provenance.bulletPackage)},
            {"compiler", provenance.compiler},
            {"compilerFlags", orNull(provenance.compilerFlags)},
            {"programFlags", orNull(provenance.programFlags)},
            {"optimised", provenance.optimised},
            {"assertions", provenance.hasAssertions},
            {"buildType", orNull(provenance.buildType)},
            {"forMeasuring", provenance.isForMeasuring},
            {"instructionSet", provenance.instructionSet},
            {"operatingSystem", provenance.operatingSystem},
            {"cpu", provenance.cpu},
            {"cores", provenance.cores},
            {"coresOfOthers", orNull(provenance.coresOfOthers)},
            {"commandLine", provenance.commandLine}};
}

}  // namespace hashphase::demos
