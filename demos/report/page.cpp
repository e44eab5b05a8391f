// SPDX-License-Identifier: Zlib
#include <demos/report/page.hpp>

#include <demos/console/format.hpp>
#include <demos/report/chart_scripts.hpp>
#include <demos/report/html.hpp>
#include <demos/report/report_text.hpp>
#include <demos/report/vega_lite.hpp>

#include <ostream>

namespace hashphase::demos {
namespace {

constexpr const char* kProvenanceHeading = "Where this was measured";
constexpr const char* kReportTab = "report";

/// Where in the document something stands.
struct Place {
    std::string idPrefix;  // keeps the ids of parts apart
    int headingLevel = 2;  // of sections; their charts are one below
};

std::string idOfPart(std::size_t index) {
    return "part-" + std::to_string(index + 1);
}

Place placeOfPart(std::size_t index) {
    return {idOfPart(index) + "-", 3};
}

std::string idOfSection(const Place& place, std::size_t index) {
    return place.idPrefix + "section-" + std::to_string(index);
}

std::string heading(int level, const std::string& text) {
    const std::string tag = "h" + std::to_string(level) + ">";
    return "<" + tag + escaped(text) + "</" + tag;
}

void addTabs(const Page& page, std::vector<const PageTab*>& tabs) {
    for (const PageTab& tab : page.tabs) {
        tabs.push_back(&tab);
    }
    for (const Page& part : page.parts) {
        addTabs(part, tabs);
    }
}

/// Writes one page, piece by piece.
class PageWriter {
public:
    PageWriter(const Page& page, std::ostream& out)
        : page_(page), out_(out), looks_(seriesLooks(page)) {
        addTabs(page, tabs_);
    }

    void write() const {
        writeHead();
        out_ << "<body>\n<main>\n";
        writeTop();
        if (tabs_.empty()) {
            writeReport();
        } else {
            writeTabs();
        }
        out_ << "</main>\n";
        writeScripts();
        out_ << "</body>\n</html>\n";
    }

private:
    void writeHead() const;
    void writeTop() const;
    void writeVerdict(const Page& page) const;
    void writeTabs() const;
    void writeTab(const std::string& name, const std::string& title) const;
    void beginPanel(const std::string& name) const;
    void writeReport() const;
    void writeContents() const;
    void writeLinks(const Page& page, const Place& place) const;
    void writePart(std::size_t index) const;
    void writeSections(const Page& page, const Place& place) const;
    void writeSection(const PageSection& section, const Place& place) const;
    void writeChecks(const std::vector<Check>& checks) const;
    void writeChart(const Chart& chart, const Place& place) const;
    void writeProvenance() const;
    void writeScripts() const;
    [[nodiscard]] std::string admittedScripts() const;
    void writeParagraph(const std::string& text) const {
        out_ << "<p>" << escaped(text) << "</p>\n";
    }
    void writeList(const std::vector<std::string>& sentences) const;

    const Page& page_;
    std::ostream& out_;
    SeriesLooks looks_;
    std::vector<const PageTab*> tabs_;  // the page's own, and those of its parts
    ChartScripts scripts_ = chartScripts();
};

// Data are never code: the policy admits the scripts that the program brings along, by their hashes.
// Vega sets styles of the elements it draws.
void PageWriter::writeHead() const {
    out_ << "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
            "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src "
         << admittedScripts()
         << "; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'\">\n"
            "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>"
         << escaped(page_.title) << "</title>\n<style>" << pageStyle();
    for (const PageTab* tab : tabs_) {
        out_ << tab->style;
    }
    out_ << "</style>\n</head>\n";
}

std::string PageWriter::admittedScripts() const {
    std::string hashes;
    const auto admit = [&hashes](std::string_view hash) {
        hashes.append(hashes.empty() ? "'" : " '").append(hash).append("'");
    };
    if (!scripts_.code.empty()) {
        admit(scripts_.hash);
    }
    for (const PageTab* tab : tabs_) {
        admit(policyHash(tab->script));
    }
    if (!tabs_.empty()) {
        admit(policyHash(tabsScript()));
    }
    return hashes.empty() ? "'none'" : hashes;
}

// A tab's script is there before the one that shows a tab.
void PageWriter::writeScripts() const {
    const auto write = [this](std::string_view code) {
        out_ << "<script>" << code << "</script>\n";
    };
    if (!scripts_.code.empty()) {
        write(scripts_.code);
    }
    for (const PageTab* tab : tabs_) {
        write(tab->script.code);
    }
    if (!tabs_.empty()) {
        write(tabsScript().code);
    }
}

void PageWriter::writeTop() const {
    out_ << "<header>\n<h1>" << escaped(page_.title) << "</h1>\n";
    writeParagraph(page_.introduction);
    writeVerdict(page_);
    const std::string caution = cautionOf(page_.provenance);
    if (!caution.empty()) {
        out_ << "<p class=\"verdict unchecked\">" << escaped(caution) << "</p>\n";
    }
    if (scripts_.code.empty()) {
        out_ << "<p class=\"quiet\">" << escaped(scripts_.whyNone)
             << " This page has the numbers of all charts as tables.</p>\n";
    } else {
        out_ << "<noscript><p class=\"quiet\">Charts are drawn by JavaScript, which is off. Their "
                "numbers are in the tables below their titles.</p></noscript>\n";
    }
    out_ << "</header>\n";
}

void PageWriter::writeVerdict(const Page& page) const {
    const char* const look = !page.holds ? " unchecked" : *page.holds ? "" : " bad";
    out_ << "<p class=\"verdict" << look << "\">" << escaped(page.verdict) << "</p>\n";
}

void PageWriter::writeTabs() const {
    out_ << "<div class=\"tabs\" role=\"tablist\" aria-label=\"Views\" hidden>\n";
    writeTab(kReportTab, "Report");
    for (const PageTab* tab : tabs_) {
        writeTab(tab->name, tab->title);
    }
    out_ << "</div>\n";
    beginPanel(kReportTab);
    writeReport();
    out_ << "</div>\n";
    for (const PageTab* tab : tabs_) {
        beginPanel(tab->name);
        out_ << tab->content << "</div>\n";
    }
}

void PageWriter::writeTab(const std::string& name, const std::string& title) const {
    out_ << "<button type=\"button\" role=\"tab\" id=\"tab-" << name << "\" aria-controls=\""
         << name << "\">" << escaped(title) << "</button>\n";
}

void PageWriter::beginPanel(const std::string& name) const {
    out_ << "<div role=\"tabpanel\" id=\"" << name << "\" aria-labelledby=\"tab-" << name
         << "\">\n";
}

void PageWriter::writeReport() const {
    writeContents();
    writeSections(page_, {});
    for (std::size_t i = 0; i < page_.parts.size(); ++i) {
        writePart(i);
    }
    writeProvenance();
}

void PageWriter::writeLinks(const Page& page, const Place& place) const {
    for (std::size_t i = 0; i < page.sections.size(); ++i) {
        out_ << "<li><a href=\"#" << idOfSection(place, i) << "\">"
             << escaped(page.sections[i].heading) << "</a></li>\n";
    }
}

// The sections of a part are folded up, so that the parts can be seen at a glance.
void PageWriter::writeContents() const {
    out_ << "<nav class=\"contents\" aria-label=\"Contents\"><ul>\n";
    writeLinks(page_, {});
    for (std::size_t i = 0; i < page_.parts.size(); ++i) {
        const Page& part = page_.parts[i];
        out_ << "<li><a href=\"#" << idOfPart(i) << "\">" << escaped(part.title) << "</a>";
        if (!part.sections.empty()) {
            out_ << "\n<details><summary>Its sections: " << part.sections.size()
                 << "</summary><ul>\n";
            writeLinks(part, placeOfPart(i));
            out_ << "</ul></details>";
        }
        out_ << "</li>\n";
    }
    out_ << "<li><a href=\"#provenance\">" << kProvenanceHeading << "</a></li>\n</ul></nav>\n";
}

void PageWriter::writePart(std::size_t index) const {
    const Page& part = page_.parts[index];
    out_ << "<article class=\"part\" id=\"" << idOfPart(index) << "\">\n"
         << heading(2, part.title) << '\n';
    writeParagraph(part.introduction);
    writeVerdict(part);
    if (!part.provenance.commandLine.empty()) {
        out_ << "<p class=\"quiet\">This part alone: <code>" << escaped(part.provenance.commandLine)
             << "</code></p>\n";
    }
    writeSections(part, placeOfPart(index));
    out_ << "</article>\n";
}

void PageWriter::writeSections(const Page& page, const Place& place) const {
    for (std::size_t i = 0; i < page.sections.size(); ++i) {
        const PageSection& section = page.sections[i];
        out_ << "<section id=\"" << idOfSection(place, i) << "\">\n"
             << heading(place.headingLevel, section.heading) << '\n';
        writeSection(section, place);
        out_ << "</section>\n";
    }
}

void PageWriter::writeSection(const PageSection& section, const Place& place) const {
    for (const std::string& sentence : section.sentences) {
        writeParagraph(sentence);
    }
    writeList(section.conclusions);
    for (const GradedTable& table : section.graded) {
        writeGradedTable(table, out_);
    }
    writeChecks(section.checks);
    for (const Chart& chart : section.charts) {
        writeChart(chart, place);
    }
    for (const DataTable& table : section.tables) {
        writeTable(table, out_);
    }
    if (!section.settings.empty()) {
        out_ << "<details><summary>How it was measured</summary>\n";
        writeList(section.settings);
        out_ << "</details>\n";
    }
}

void PageWriter::writeList(const std::vector<std::string>& sentences) const {
    if (sentences.empty()) {
        return;
    }
    out_ << "<ul>\n";
    for (const std::string& sentence : sentences) {
        out_ << "<li>" << escaped(sentence) << "</li>\n";
    }
    out_ << "</ul>\n";
}

void PageWriter::writeChecks(const std::vector<Check>& checks) const {
    if (checks.empty()) {
        return;
    }
    out_ << "<ul class=\"checks\">\n";
    for (const Check& check : checks) {
        out_ << "<li>"
             << (check.holds ? "<span class=\"holds\">holds</span>"
                             : "<span class=\"broken\">BROKEN</span>")
             << "<span>" << escaped(check.claim) << " <span class=\"quiet\">("
             << escaped(check.evidence) << ")</span></span></li>\n";
    }
    out_ << "</ul>\n";
}

void PageWriter::writeChart(const Chart& chart, const Place& place) const {
    const bool isMeasured = !chart.data.rows.empty();
    const bool isDrawn = isMeasured && !scripts_.code.empty();
    out_ << "<figure" << (isDrawn ? " class=\"chart\"" : "") << " id=\""
         << escaped(place.idPrefix + chart.name) << "\">\n<figcaption>"
         << heading(place.headingLevel + 1, chart.title) << "<p>" << escaped(chart.settings)
         << "</p></figcaption>\n";
    if (!isMeasured) {
        out_ << "<p>Nothing was measured.</p>\n</figure>\n";
        return;
    }
    if (isDrawn) {
        out_ << "<div class=\"drawing\"></div>\n<script type=\"application/json\">"
             << jsonInScript(vegaLiteSpec(chart, looks_, pageTheme(), ChartTitle::kNone))
             << "</script>\n";
    }
    out_ << "<details" << (isDrawn ? "" : " open")
         << "><summary>The numbers of this chart</summary>\n";
    writeTable(chart.data, out_);
    out_ << "</details>\n</figure>\n";
}

void PageWriter::writeProvenance() const {
    const Provenance& provenance = page_.provenance;
    DataTable table{{{"what", "what"}, {"value", "value"}}, {}};
    table.add({"hashphase", provenance.hashphaseVersion});
    table.add({"Bullet", provenance.bulletVersion + ", " + provenance.precision + " precision"});
    table.add({"compiler", provenance.compiler});
    table.add({"its flags", flagsText(provenance)});
    table.add({"build", provenance.buildType + (provenance.isForMeasuring
                                                    ? ", for measuring"
                                                    : ", for tests: times mean little")});
    table.add({"assertions", provenance.hasAssertions ? "on" : "off"});
    table.add({"processor", provenance.cpu});
    table.add({"instructions that hashphase uses", provenance.instructionSet});
    table.add({"cores", std::to_string(provenance.cores)});
    if (provenance.loadAverage) {
        const auto& [one, five, fifteen] = *provenance.loadAverage;
        table.add({"load over 1, 5, 15 minutes before",
                   fixed(one, 2) + ", " + fixed(five, 2) + ", " + fixed(fifteen, 2)});
    }
    table.add({"command", provenance.commandLine});
    out_ << "<section id=\"provenance\">\n<h2>" << kProvenanceHeading << "</h2>\n";
    writeTable(table, out_);
    out_ << "</section>\n";
}

void addCharts(const Page& page, std::vector<const Chart*>& charts) {
    for (const PageSection& section : page.sections) {
        for (const Chart& chart : section.charts) {
            charts.push_back(&chart);
        }
    }
    for (const Page& part : page.parts) {
        addCharts(part, charts);
    }
}

}  // namespace

void writePage(const Page& page, std::ostream& out) {
    PageWriter(page, out).write();
}

void deliverPage(const Page& page, ResultFile& file, const Console& console) {
    file.write([&page](std::ostream& out) { writePage(page, out); });
    if (console.takePage) {
        console.takePage(page);
    }
}

SeriesLooks seriesLooks(const Page& page) {
    std::vector<const Chart*> charts;
    addCharts(page, charts);
    return seriesLooks(charts);
}

}  // namespace hashphase::demos
