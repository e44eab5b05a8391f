// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/experiment/measurements.hpp>

#include <string>

namespace hashphase::demos {

/// All rows that the SQL gives, "12 0.5 -; 13 1 text".
[[nodiscard]] inline std::string asked(Measurements& measured, std::string_view sql) {
    std::string text;
    for (const std::vector<Value>& row : measured.ask(sql).rows) {
        text += text.empty() ? "" : "; ";
        for (const Value& value : row) {
            text += (&value == row.data() ? "" : " ") + valueText(value);
        }
    }
    return text;
}

}  // namespace hashphase::demos
