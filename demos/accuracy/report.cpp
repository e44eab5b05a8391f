// SPDX-License-Identifier: Zlib
#include <demos/accuracy/report.hpp>

#include <demos/accuracy/accuracy_page.hpp>
#include <demos/accuracy/advice.hpp>
#include <demos/console/result_file.hpp>
#include <demos/console/table.hpp>
#include <demos/report/json_values.hpp>
#include <demos/report/report_text.hpp>
#include <demos/report/vega_lite.hpp>

#include <ostream>

namespace hashphase::demos {
namespace {

void print(const DataTable& data, std::ostream& out) {
    std::vector<std::string> header;
    for (const DataColumn& column : data.columns) {
        header.push_back(titleOf(column));
    }
    Table table(header);
    for (const std::vector<Value>& row : data.rows) {
        std::vector<std::string> cells;
        for (const Value& value : row) {
            cells.push_back(valueText(value));
        }
        table.addRow(std::move(cells));
    }
    table.print(out);
}

Json tableJson(const DataTable& data) {
    Json columns = Json::array();
    for (const DataColumn& column : data.columns) {
        columns.push_back({{"name", column.name}, {"title", column.title}});
    }
    Json rows = Json::array();
    for (const std::vector<Value>& row : data.rows) {
        Json cells = Json::array();
        for (const Value& value : row) {
            cells.push_back(valueJson(value));
        }
        rows.push_back(std::move(cells));
    }
    return {{"columns", std::move(columns)}, {"rows", std::move(rows)}};
}

template <class Write>
void writeFile(const std::string& folder, const std::string& name, const Write& write) {
    ResultFile file(folder + "/" + name);
    file.write(write);
}

}  // namespace

void printReport(const AccuracyReport& report, std::ostream& out) {
    for (const Outcome& outcome : report.outcomes) {
        const Findings& findings = outcome.findings;
        out << outcome.experiment->id << ' ' << outcome.experiment->title << ": "
            << outcome.experiment->question << '\n';
        for (const DataTable& table : findings.tables) {
            out << '\n';
            print(table, out);
        }
        out << '\n';
        for (const Check& check : findings.checks) {
            out << (check.holds ? "  holds   " : "  BROKEN  ") << check.claim << " ("
                << check.evidence << ")\n";
        }
        for (const std::string& conclusion : findings.conclusions) {
            out << "  " << conclusion << '\n';
        }
        out << '\n';
    }
    const std::vector<Choice> choices = allChoices(report);
    if (!choices.empty()) {
        print(adviceTable(choices), out);
        out << '\n';
    }
    printProvenance(report.provenance, out);
    out << verdictLine(report) << '\n';
    for (const std::string& broken : brokenChecks(report)) {
        out << broken << '\n';
    }
}

void writeJson(const AccuracyReport& report, const Outcome& outcome, std::ostream& out) {
    const Findings& findings = outcome.findings;
    Json json{{"schema", "hashphase-accuracy"},
              {"schemaVersion", 1},
              {"provenance", provenanceJson(report.provenance)},
              {"experiment", outcome.experiment->id},
              {"title", outcome.experiment->title},
              {"question", outcome.experiment->question},
              {"quick", report.effort.isQuick},
              {"seed", report.effort.seed},
              {"seconds", outcome.seconds},
              {"settings", findings.settings},
              {"checks", Json::array()},
              {"conclusions", findings.conclusions},
              {"charts", Json::array()},
              {"tables", Json::array()},
              {"choices", Json::array()}};
    for (const Check& check : findings.checks) {
        json["checks"].push_back(
            {{"claim", check.claim}, {"holds", check.holds}, {"evidence", check.evidence}});
    }
    for (const Chart& chart : findings.charts) {
        json["charts"].push_back({{"name", chart.name},
                                  {"title", chart.title},
                                  {"settings", chart.settings},
                                  {"data", tableJson(chart.data)}});
    }
    for (const DataTable& table : findings.tables) {
        json["tables"].push_back(tableJson(table));
    }
    for (const Choice& choice : findings.choices) {
        json["choices"].push_back({{"task", choice.task},
                                   {"method", choice.method},
                                   {"milliseconds", valueJson(choice.milliseconds)},
                                   {"error", valueJson(choice.error)},
                                   {"result", choice.result},
                                   {"ours", choice.isOurs}});
    }
    out << textOf(json);
}

void writeReport(const AccuracyReport& report, const std::string& folder) {
    const SeriesLooks looks = seriesLooks(pageOf(report));
    for (const Outcome& outcome : report.outcomes) {
        writeFile(folder, std::string(outcome.experiment->id) + ".json",
                  [&](std::ostream& file) { writeJson(report, outcome, file); });
        for (const Chart& chart : outcome.findings.charts) {
            writeFile(folder, chart.name + ".csv",
                      [&](std::ostream& file) { writeCsv(chart.data, file); });
            writeFile(folder, chart.name + ".vl.json", [&](std::ostream& file) {
                file << textOf(vegaLiteSpec(chart, looks, pictureTheme(), ChartTitle::kInside));
            });
        }
    }
    writeFile(folder, "advice.csv",
              [&](std::ostream& file) { writeCsv(adviceTable(allChoices(report)), file); });
}

}  // namespace hashphase::demos
