// SPDX-License-Identifier: Zlib
#include <demos/experiment/findings.hpp>

#include <demos/report/json_values.hpp>

#include <algorithm>
#include <array>
#include <stdexcept>

namespace hashphase::demos {
namespace {

std::string textAt(const std::vector<Value>& row, std::size_t column) {
    return valueText(row.at(column));
}

double numberAt(const std::vector<Value>& row, std::size_t column) {
    const double* number = std::get_if<double>(&row.at(column));
    return number != nullptr ? *number : 0;
}

Grade gradeNamed(const std::string& name) {
    return name == "good"   ? Grade::kGood
           : name == "fair" ? Grade::kFair
           : name == "poor" ? Grade::kPoor
                            : Grade::kNone;
}

/// Adds a cell to the row of the graded table that it belongs to, which follow each other.
void addGraded(const std::vector<Value>& cell, GradedTable& graded) {
    const auto isSame = [&](const std::vector<GradedText>& row) {
        return row[0].text == textAt(cell, 0) && row[1].text == textAt(cell, 1);
    };
    if (graded.rows.empty() || !isSame(graded.rows.back())) {
        graded.rows.push_back({{textAt(cell, 0)}, {textAt(cell, 1)}});
    }
    graded.rows.back().push_back({textAt(cell, 3), gradeNamed(textAt(cell, 4))});
    if (graded.rows.size() == 1) {
        graded.header.push_back(textAt(cell, 2));
    }
}

/// Takes the comments in front of the next statement, and returns the JSON that one of them holds; null
/// where there is none.
Json takeHeading(std::string_view& sql) {
    Json heading;
    for (;;) {
        sql.remove_prefix(std::min(sql.find_first_not_of(" \n"), sql.size()));
        std::size_t end = std::string_view::npos;
        if (sql.starts_with("--")) {
            end = sql.find('\n');
        } else if (sql.starts_with("/*")) {
            end = sql.find("*/");
            const std::string_view comment = sql.substr(2, end - 2);
            if (comment.find('{') != std::string_view::npos) {
                heading = Json::parse(comment);
            }
            end += 2;
        } else {
            return heading;
        }
        sql.remove_prefix(std::min(end, sql.size()));
    }
}

/// Throws for a mark, a column or a scale that there is not.
void refuseWhatCannotBeDrawn(const Chart& chart, const std::string& key, const std::string& words) {
    constexpr std::array<std::string_view, 4> kMarks{"line", "point", "bar", "cell"};
    constexpr std::array<std::string_view, 4> kScales{"linear", "log", "log0", "names"};
    const std::size_t blank = std::min(words.find(' '), words.size());
    const bool isMark = key == "mark";
    if (!isMark) {
        static_cast<void>(chart.data.columnOf(words.substr(0, blank)));  // throws
    }
    const auto& known = isMark ? kMarks : kScales;
    const std::string word = isMark ? words : words.substr(std::min(blank + 1, words.size()));
    if (!word.empty() && std::ranges::find(known, word) == known.end()) {
        throw std::logic_error("Nothing is drawn as '" + word + "'.");
    }
}

class Shower {
public:
    explicit Shower(Measurements& measured) : measured_(measured) {}

    [[nodiscard]] Findings show(std::string_view sql) {
        std::vector<Shown> together;
        for (Json heading = takeHeading(sql); !sql.empty(); heading = takeHeading(sql)) {
            if (heading.is_null() ||
                (!together.empty() &&
                 heading.value("each", "") != together.front().heading.value("each", ""))) {
                showInTurn(together);
                together.clear();
            }
            if (heading.is_null()) {
                measured_.take(sql);
            } else {
                together.push_back({std::move(heading), sql});
                measured_.skip(sql);
            }
        }
        showInTurn(together);
        return std::move(findings_);
    }

private:
    struct Shown {
        Json heading;
        std::string_view sql;
    };

    /// Statements with the same "each".
    void showInTurn(const std::vector<Shown>& together) {
        if (together.empty()) {
            return;
        }
        for (const Record& parameters : parametersOf(together.front().heading)) {
            for (const auto& [heading, sql] : together) {
                if (filled(heading.value("when", "1"), parameters) != "0") {
                    showAs(heading, measured_.ask(sql, parameters), parameters);
                }
            }
        }
    }

    /// Of each time that the statement is shown.
    [[nodiscard]] std::vector<Record> parametersOf(const Json& heading) {
        if (!heading.contains("each")) {
            return {{}};
        }
        each_ = measured_.ask(heading["each"].get<std::string>());
        std::vector<Record> all;
        for (const std::vector<Value>& row : each_.rows) {
            Record& parameters = all.emplace_back();
            for (std::size_t i = 0; i < row.size(); ++i) {
                parameters.emplace_back(each_.columns[i].name, row[i]);
            }
        }
        return all;
    }

    /// The text with its expressions' values.
    [[nodiscard]] std::string filled(std::string text, const Record& parameters) {
        for (std::size_t begin = text.find('{'); begin != std::string::npos;
             begin = text.find('{', begin)) {
            const std::size_t end = text.find('}', begin);
            const DataTable value = measured_.ask(
                "SELECT " + text.substr(begin + 1, end - begin - 1) + " FROM texts", parameters);
            const std::string inserted = valueText(value.rows.at(0).at(0));
            text.replace(begin, end - begin + 1, inserted);
            begin += inserted.size();
        }
        return text;
    }

    // "name: title" -> a column of that name and title.
    void nameColumns(DataTable& table, const Record& parameters) {
        for (DataColumn& column : table.columns) {
            const std::size_t end = column.name.find(": ");
            if (end != std::string::npos) {
                column.title = filled(column.name.substr(end + 2), parameters);
                column.name.resize(end);
            }
        }
    }

    void showAs(const Json& heading, DataTable found, const Record& parameters) {
        if (heading.contains("spread")) {
            found = spread(found);
        }
        nameColumns(found, parameters);
        if (heading.contains("section")) {
            showInSection(heading, std::move(found), parameters);
        } else if (heading.contains("choices")) {
            for (const std::vector<Value>& row : found.rows) {
                findings_.choices.push_back({textAt(row, 0), textAt(row, 1), numberAt(row, 2),
                                             numberAt(row, 3), textAt(row, 4),
                                             numberAt(row, 5) != 0, numberAt(row, 6)});
            }
        } else if (heading.contains("verdict")) {
            const std::vector<Value>& row = found.rows.at(0);
            findings_.verdict = textAt(row, 0);
            findings_.holds =
                row.at(1).index() == 0 ? std::nullopt : std::optional(numberAt(row, 1) != 0);
        } else if (heading.contains("rows")) {
            findings_.rows[heading["rows"].get<std::string>()] = std::move(found);
        } else if (heading.contains("print")) {
            findings_.printed.emplace_back(filled(heading["print"], parameters), std::move(found));
        } else {
            showIn(findings_, heading, std::move(found), parameters);
        }
    }

    void showInSection(const Json& heading, DataTable found, const Record& parameters) {
        const std::string name = filled(heading["section"], parameters);
        const auto section =
            std::find_if(findings_.sections.begin(), findings_.sections.end(),
                         [&](const PageSection& each) { return each.heading == name; });
        if (heading.contains("sentences")) {
            PageSection begun;
            begun.heading = name;
            addSentences(found, begun.sentences);
            if (!begun.sentences.empty()) {
                findings_.sections.push_back(std::move(begun));
            }
        } else if (section == findings_.sections.end()) {
            return;
        } else if (heading.contains("graded")) {
            GradedTable& graded = section->graded.emplace_back();
            graded.caption = filled(heading["graded"], parameters);
            graded.legend = heading.at("legend").get<std::array<std::string, 3>>();
            graded.header = {titleOf(found.columns.at(0)), titleOf(found.columns.at(1))};
            for (const std::vector<Value>& cell : found.rows) {
                addGraded(cell, graded);
            }
        } else {
            showIn(*section, heading, std::move(found), parameters);
        }
    }

    /// In all findings, or in a section of them.
    template <class Place>
    void showIn(Place& place, const Json& heading, DataTable found, const Record& parameters) {
        if (heading.contains("chart")) {
            place.charts.push_back(chartOf(heading, std::move(found), parameters));
        } else if (heading.contains("table")) {
            place.tables.push_back(std::move(found));
        } else if (heading.contains("settings")) {
            addSentences(found, place.settings);
        } else if (heading.contains("conclusions")) {
            addSentences(found, place.conclusions);
        } else if (heading.contains("checks")) {
            for (const std::vector<Value>& row : found.rows) {
                place.checks.push_back({textAt(row, 0), numberAt(row, 1) != 0, textAt(row, 2)});
            }
        } else {
            throw std::logic_error("Nothing is shown as " + heading.dump() + '.');
        }
    }

    [[nodiscard]] Chart chartOf(const Json& heading, DataTable data, const Record& parameters) {
        Chart chart;
        chart.name = filled(heading["chart"], parameters);
        chart.title = filled(heading.value("title", ""), parameters);
        chart.settings = filled(heading.value("settings", ""), parameters);
        chart.data = std::move(data);
        for (const char* key :
             {"mark", "x", "y", "series", "low", "high", "label", "shade", "theory"}) {
            if (heading.contains(key)) {
                chart.drawn[key] = heading[key].get<std::string>();
                refuseWhatCannotBeDrawn(chart, key, chart.drawn[key]);
            }
        }
        const auto require = [&chart](const char* key) {
            if (!chart.drawn.contains(key)) {
                throw std::logic_error("The chart '" + chart.name + "' has no " + key + '.');
            }
        };
        require("x");
        require("y");
        if (heading.value("mark", "") == "bar" &&
            chart.drawn["y"].find(" log") != std::string::npos) {
            throw std::logic_error("The bars of '" + chart.name +
                                   "' cannot begin at 0 on a logarithmic axis: draw points.");
        }
        if (heading.value("mark", "") == "cell") {
            require("shade");
        }
        if (heading.value("front", false)) {
            chart.drawn["front"] = "true";
        }
        return chart;
    }

    static void addSentences(const DataTable& found, std::vector<std::string>& sentences) {
        for (std::string& sentence : sentencesOf(found)) {
            sentences.push_back(std::move(sentence));
        }
    }

    Measurements& measured_;
    DataTable each_;  // whose columns the parameters name
    Findings findings_;
};

}  // namespace

std::vector<std::string> sentencesOf(const DataTable& table) {
    std::vector<std::string> sentences;
    for (const std::vector<Value>& row : table.rows) {
        if (const auto* sentence = std::get_if<std::string>(&row.at(0)); sentence != nullptr) {
            sentences.push_back(*sentence);
        }
    }
    return sentences;
}

Findings findingsOf(std::string_view declaration, Measurements& measured) {
    return Shower(measured).show(declaration);
}

}  // namespace hashphase::demos
