// SPDX-License-Identifier: Zlib
#pragma once

// Texts and tables as HTML.

#include <demos/report/data_table.hpp>
#include <demos/report/json_values.hpp>

#include <iosfwd>
#include <string>
#include <string_view>

namespace hashphase::demos {

/// The text with what HTML reads as markup escaped, for between tags and within quoted attributes.
[[nodiscard]] std::string escaped(std::string_view text);

/// JSON for within a <script>: nothing in it can end the script.
[[nodiscard]] std::string jsonInScript(const Json& json);

/// A table with the titles of the columns; numbers stand to the right, and a text of the first
/// column that is that of the rows above stands once.
void writeTable(const DataTable& table, std::ostream& out);

}  // namespace hashphase::demos
