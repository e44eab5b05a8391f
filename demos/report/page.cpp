// SPDX-License-Identifier: Zlib
#include <demos/report/page.hpp>

#include <demos/console/format.hpp>
#include <demos/report/base64.hpp>
#include <demos/report/chart_scripts.hpp>
#include <demos/report/json_values.hpp>
#include <demos/report/report_text.hpp>

#include <algorithm>
#include <charconv>
#include <ostream>

namespace hashphase::demos {
namespace {

constexpr const char* kProvenanceHeading = "Where this was measured";
constexpr const char* kReportTab = "report";

std::string paragraph(const std::string& text, const std::string& look = {}) {
    return tag(look.empty() ? "p" : "p class=\"" + look + '"', escaped(text)) + '\n';
}

std::string heading(int level, const std::string& text) {
    return tag("h" + std::to_string(level), escaped(text));
}

std::string list(const std::vector<std::string>& sentences) {
    std::string items;
    for (const std::string& sentence : sentences) {
        items += tag("li", escaped(sentence)) + '\n';
    }
    return items.empty() ? items : tag("ul", '\n' + items) + '\n';
}

std::string folded(const std::string& summary, const std::string& content) {
    return tag("details", tag("summary", summary) + '\n' + content);
}

std::string list(const std::vector<Check>& checks) {
    std::string items;
    for (const Check& check : checks) {
        items += tag("li", tag(check.holds ? "span class=\"holds\"" : "span class=\"broken\"",
                               check.holds ? "holds" : "BROKEN") +
                               tag("span", escaped(check.claim) + " " +
                                               tag("span class=\"quiet\"",
                                                   "(" + escaped(check.evidence) + ")"))) +
                 '\n';
    }
    return items.empty() ? items : tag("ul class=\"checks\"", '\n' + items) + '\n';
}

// --- The page -------------------------------------------------------------------------------------

/// Where in the document something stands.
struct Place {
    std::string idPrefix;   // keeps the ids of parts apart
    int headingLevel = 2;   // of sections; their charts are one below
    bool isFolded = false;  // so that a page of many parts can be seen at a glance

    [[nodiscard]] std::string sectionId(std::size_t index) const {
        return idPrefix + "section-" + std::to_string(index);
    }
};

std::string idOfPart(std::size_t index) {
    return "part-" + std::to_string(index + 1);
}

Place placeOfPart(std::size_t index) {
    return {idOfPart(index) + "-", 3, true};
}

std::string verdictOf(const Page& page) {
    return paragraph(page.verdict, !page.holds   ? "verdict unchecked"
                                   : *page.holds ? "verdict"
                                                 : "verdict bad");
}

std::string linksTo(const Page& page, const Place& place) {
    std::string links;
    for (std::size_t i = 0; i < page.sections.size(); ++i) {
        links += tag("li", tag("a href=\"#" + place.sectionId(i) + '"',
                               escaped(page.sections[i].heading))) +
                 '\n';
    }
    return links;
}

/// Writes one page, piece by piece.
class PageWriter {
public:
    PageWriter(const Page& page, std::ostream& out) : page_(page), out_(out) { addTabs(page); }

    void write() {
        writeHead();
        out_ << "<body>\n<main>\n";
        writeTop();
        if (tabs_.empty()) {
            writeReport();
        } else {
            writeTabs();
        }
        out_ << "</main>\n";
        for (const auto& [code, hash] : scripts()) {
            out_ << "<script>" << code << "</script>\n";
        }
        out_ << "</body>\n</html>\n";
    }

private:
    void addTabs(const Page& page) {
        for (const PageTab& tab : page.tabs) {
            tabs_.push_back(&tab);
        }
        for (const Page& part : page.parts) {
            addTabs(part);
        }
    }

    /// With their hashes. A tab's script comes before the one that shows a tab.
    [[nodiscard]] std::vector<std::pair<std::string_view, std::string>> scripts() const {
        std::vector<std::pair<std::string_view, std::string>> all;
        if (hasCharts()) {
            all.emplace_back(chartScripts_.code, chartScripts_.hash);
        }
        for (const PageTab* tab : tabs_) {
            all.emplace_back(tab->script.code, policyHash(tab->script));
        }
        all.emplace_back(navigationScript().code, policyHash(navigationScript()));
        return all;
    }

    [[nodiscard]] bool hasCharts() const { return !chartScripts_.code.empty(); }

    // Data are never code: the policy admits the scripts that the program brings along, by their hashes.
    // Vega sets styles of the elements it draws.
    void writeHead() const {
        std::string admitted;
        for (const auto& [code, hash] : scripts()) {
            admitted += (admitted.empty() ? "'" : " '") + hash + '\'';
        }
        out_ << "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
                "script-src "
             << admitted
             << "; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'\">\n"
                "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
             << tag("title", escaped(page_.title)) << "\n<style>" << pageStyle();
        for (const PageTab* tab : tabs_) {
            out_ << tab->style;
        }
        out_ << "</style>\n</head>\n";
    }

    void writeTop() const {
        std::string cautions;
        for (const std::string& caution : cautionsOf(page_.provenance)) {
            cautions += paragraph(caution, "verdict unchecked");
        }
        const std::string onCharts =
            hasCharts() ? tag("noscript",
                              tag("p class=\"quiet\"",
                                  "Charts need JavaScript, which is off. Their numbers are in the "
                                  "tables below their titles.")) +
                              '\n'
                        : paragraph(std::string(chartScripts_.whyNone) +
                                        " This page has the numbers of all charts as tables.",
                                    "quiet");
        out_ << tag("header", '\n' + heading(1, page_.title) + '\n' +
                                  paragraph(page_.introduction) + verdictOf(page_) + cautions +
                                  onCharts)
             << '\n';
    }

    void writeTabs() const {
        out_ << "<div class=\"tabs\" role=\"tablist\" aria-label=\"Views\" hidden>\n";
        const auto button = [&](const std::string& name, const std::string& title) {
            out_ << tag("button type=\"button\" role=\"tab\" id=\"tab-" + name +
                            "\" aria-controls=\"" + name + '"',
                        escaped(title))
                 << '\n';
        };
        const auto beginPanel = [&](const std::string& name) {
            out_ << "<div role=\"tabpanel\" id=\"" << name << "\" aria-labelledby=\"tab-" << name
                 << "\">\n";
        };
        button(kReportTab, "Report");
        for (const PageTab* tab : tabs_) {
            button(tab->name, tab->title);
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

    void writeReport() const {
        out_ << "<div class=\"report\">\n";
        writeContents();
        out_ << "<div class=\"content\">\n";
        writeSections(page_, {});
        for (std::size_t i = 0; i < page_.parts.size(); ++i) {
            writePart(i);
        }
        out_ << "<section id=\"provenance\">\n" << heading(2, kProvenanceHeading) << '\n';
        writeTable(provenanceTable(page_.provenance), out_);
        out_ << "</section>\n</div>\n</div>\n";
    }

    // The sections of a part are folded up, so that the parts can be seen at a glance.
    void writeContents() const {
        std::string items = linksTo(page_, {});
        for (std::size_t i = 0; i < page_.parts.size(); ++i) {
            const Page& part = page_.parts[i];
            std::string item = tag("a href=\"#" + idOfPart(i) + '"', escaped(part.title));
            if (!part.sections.empty()) {
                item += '\n' + folded("Its sections: " + std::to_string(part.sections.size()),
                                      tag("ul", '\n' + linksTo(part, placeOfPart(i))));
            }
            items += tag("li", item) + '\n';
        }
        items += tag("li", tag("a href=\"#provenance\"", kProvenanceHeading)) + '\n';
        out_ << tag("nav class=\"contents\" aria-label=\"Contents\"", tag("ul", '\n' + items))
             << '\n';
    }

    void writePart(std::size_t index) const {
        const Page& part = page_.parts[index];
        out_ << "<article class=\"part\" id=\"" << idOfPart(index) << "\">\n"
             << heading(2, part.title) << '\n'
             << paragraph(part.introduction) << verdictOf(part);
        if (const std::string overload = overloadSentence(part.provenance); !overload.empty()) {
            out_ << paragraph(overload, "verdict unchecked");
        }
        if (!part.provenance.commandLine.empty()) {
            out_ << tag("p class=\"quiet\"", "To run this part alone: " +
                                                 tag("code", escaped(part.provenance.commandLine)))
                 << '\n';
        }
        writeSections(part, placeOfPart(index));
        out_ << "</article>\n";
    }

    void writeSections(const Page& page, const Place& place) const {
        for (std::size_t i = 0; i < page.sections.size(); ++i) {
            const std::string title = heading(place.headingLevel, page.sections[i].heading);
            out_ << "<section id=\"" << place.sectionId(i) << "\">\n"
                 << (place.isFolded ? "<details class=\"fold\">\n" + tag("summary", title) : title)
                 << '\n';
            writeSection(page.sections[i], place);
            out_ << (place.isFolded ? "</details>\n" : "") << "</section>\n";
        }
    }

    void writeSection(const PageSection& section, const Place& place) const {
        for (const std::string& sentence : section.sentences) {
            out_ << paragraph(sentence);
        }
        out_ << list(section.conclusions);
        for (const GradedTable& table : section.graded) {
            writeGradedTable(table, out_);
        }
        out_ << list(section.checks);
        for (const Chart& chart : section.charts) {
            writeChart(chart, place);
        }
        for (const DataTable& table : section.tables) {
            writeTable(table, out_);
        }
        if (!section.settings.empty()) {
            out_ << folded("How it was measured", list(section.settings)) << '\n';
        }
    }

    void writeChart(const Chart& chart, const Place& place) const {
        const bool isMeasured = !chart.data.rows.empty();
        const bool isDrawn = isMeasured && hasCharts();
        out_ << "<figure" << (isDrawn ? " class=\"chart\"" : "") << " id=\""
             << escaped(place.idPrefix + chart.name) << "\">\n"
             << tag("figcaption", heading(place.headingLevel + 1, chart.title) +
                                      tag("p", escaped(chart.settings)))
             << '\n';
        if (isDrawn) {
            out_ << "<div class=\"drawing\"></div>\n"
                 << tag("script type=\"application/json\"", jsonInScript(chartJson(chart))) << '\n';
        }
        if (isMeasured) {
            out_ << "<details" << (isDrawn ? "" : " open") << '>'
                 << tag("summary", "The numbers of this chart") << '\n';
            writeTable(chart.data, out_);
            out_ << "</details>\n</figure>\n";
        } else {
            out_ << tag("p", "Nothing was measured.") << "\n</figure>\n";
        }
    }

    const Page& page_;
    std::ostream& out_;
    std::vector<const PageTab*> tabs_;  // the page's own, and those of its parts
    ChartScripts chartScripts_ = chartScripts();
};

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

std::string policyHash(const PageScript& script) {
    std::vector<std::uint8_t> bytes(script.sha256.size() / 2);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        const char* const digits = script.sha256.data() + 2 * i;
        std::from_chars(digits, digits + 2, bytes[i], 16);
    }
    return "sha256-" + base64(bytes);
}

}  // namespace hashphase::demos
