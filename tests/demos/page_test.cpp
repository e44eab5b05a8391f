// SPDX-License-Identifier: Zlib
#include <demos/report/base64.hpp>
#include <demos/report/chart_scripts.hpp>
#include <demos/report/json_values.hpp>
#include <demos/report/page.hpp>
#include <demos/report/profile_zones.hpp>
#include <demos/report/report_text.hpp>
#include <demos/system/process.hpp>
#include <tests/demos/sample_experiments.hpp>

#include <broadphase/diagnostics.hpp>
#include <broadphase/simd/kernels.hpp>

#include <LinearMath/btThreads.h>
#include <btBulletDynamicsCommon.h>

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <sstream>

namespace hashphase::demos {
namespace {

const std::string kHostile = "<script>alert('x')</script> & \"quoted\" <!-- ]]>";

/// The hash of an empty script.
constexpr const char* kNoCode = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";

/// All of a page but the scripts that it brings along, which anything may occur in.
std::string withoutScripts(const Page& page) {
    std::ostringstream out;
    writePage(page, out);
    std::string html = out.str();
    const std::string_view code = chartScripts().code;
    if (!code.empty()) {
        html.erase(html.find(code), code.size());
    }
    return html;
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) {
        ++found;
    }
    return found;
}

Page samplePage() {
    Page page{"Title", "Introduction", "Verdict", true, {}, {}};
    page.sections.push_back(
        {"Heading", {"Sentence"}, {"Conclusion"}, {}, sampleCharts(), {}, {"Setting"}});
    return page;
}

TEST(Html, EscapesWhatWouldBeMarkup) {
    EXPECT_EQ(escaped("a < b && \"c\" > 'd'"),
              "a &lt; b &amp;&amp; &quot;c&quot; &gt; &#39;d&#39;");
    EXPECT_EQ(escaped(""), "");
    const std::string json = jsonInScript({{"text", "</script><!--"}});
    EXPECT_EQ(json.find('<'), std::string::npos);
    EXPECT_EQ(Json::parse(json)["text"], "</script><!--");
    EXPECT_EQ(Json::parse(jsonInScript({{"text", "\xff"}}))["text"], "\xEF\xBF\xBD");
}

TEST(Html, WritesARepeatedFirstTextOnce) {
    std::ostringstream out;
    writeTable({{{"task"}, {"ms", "time [ms]"}}, {{"a", 1.5}, {"a", Value()}, {"b", 3.0}}}, out);
    EXPECT_EQ(out.str(),
              "<div class=\"table\"><table>\n<thead><tr><th scope=\"col\">task</th>"
              "<th scope=\"col\" class=\"number\">time [ms]</th></tr></thead>\n<tbody>\n"
              "<tr><td rowspan=\"2\">a</td><td class=\"number\">1.50</td></tr>\n"
              "<tr><td class=\"number\">-</td></tr>\n"
              "<tr><td>b</td><td class=\"number\">3.00</td></tr>\n</tbody></table></div>\n");
}

TEST(Page, EscapesTextsFromData) {
    Page page{kHostile, kHostile, kHostile, false, {}, {}};
    page.provenance.commandLine = kHostile;
    const Chart chart{"c",
                      kHostile,
                      kHostile,
                      {{{"x", kHostile}, {"m"}}, {{1.0, kHostile}}},
                      {{"mark", "point"}, {"x", "x"}, {"y", "x"}, {"series", "m"}}};
    page.sections.push_back({kHostile,
                             {kHostile},
                             {kHostile},
                             {{kHostile, false, kHostile}},
                             {chart},
                             {{{{kHostile}}, {{kHostile}}}},
                             {kHostile}});
    const std::string html = withoutScripts(page);
    EXPECT_EQ(html.find("alert('x')</script>"), std::string::npos);
    EXPECT_EQ(html.find("<script>alert"), std::string::npos);
    EXPECT_EQ(html.find("<!--"), std::string::npos);
    EXPECT_GE(count(html, "&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt;"), 14U);
}

TEST(Page, HoldsTheNumbersOfAllChartsAsTables) {
    const std::string html = withoutScripts(samplePage());
    std::size_t rows = 0;
    for (const Chart& chart : sampleCharts()) {
        rows += chart.data.rows.size() + 1;
        EXPECT_NE(html.find(" id=\"" + chart.name + "\">"), std::string::npos) << chart.name;
    }
    EXPECT_EQ(count(html.substr(0, html.find("id=\"provenance\"")), "<tr>"), rows);
}

TEST(Page, HandsChartsAsDeclaredToWhatDrawsThem) {
    if (chartScripts().code.empty()) {
        GTEST_SKIP() << chartScripts().whyNone;
    }
    const std::string html = withoutScripts(samplePage());
    for (const Chart& chart : sampleCharts()) {
        EXPECT_EQ(count(html, ">" + jsonInScript(chartJson(chart)) + "</script>"), 1U)
            << chart.name;
    }
    const Json points = chartJson(sampleCharts()[1]);
    EXPECT_EQ(points["y"], "missed log0");
    EXPECT_EQ(points["data"]["columns"][1]["title"], "time [ms a frame]");
    EXPECT_EQ(points["data"]["columns"][1]["digits"], 3);
    EXPECT_EQ(points["data"]["columns"][2]["digits"], 4);
    EXPECT_EQ(points["data"]["rows"].size(), sampleCharts()[1].data.rows.size());
    EXPECT_TRUE(points["data"]["rows"].back()[1].is_null()) << "not timed";
}

TEST(Page, DrawsNoChartOfNothing) {
    Page page = samplePage();
    page.sections[0].charts.resize(1);
    page.sections[0].charts[0].data.rows.clear();
    const std::string html = withoutScripts(page);
    EXPECT_EQ(count(html, "<p>Nothing was measured.</p>"), 1U);
    EXPECT_EQ(count(html, "class=\"drawing\""), 0U);
    EXPECT_EQ(count(html, "<th scope=\"col\">method</th>"), 0U) << "a table of nothing";
}

TEST(Page, SaysInWordsWhetherAChecksHolds) {
    Page page = samplePage();
    page.sections[0].checks = {{"One", true, "1 of 1"}, {"Other", false, "0 of 1"}};
    const std::string html = withoutScripts(page);
    EXPECT_NE(html.find(">holds</span><span>One "), std::string::npos);
    EXPECT_NE(html.find(">BROKEN</span><span>Other "), std::string::npos);
}

TEST(Page, SaysThatTimesMeanLittleUnlessItWasBuiltForMeasuring) {
    Page page = samplePage();
    page.provenance.compilerFlags = "-O2";
    page.provenance.buildType = "RelWithDebInfo";
    page.provenance.hasAssertions = true;
    page.provenance.programFlags = "-Og";
    page.provenance.instructionSet = "AVX2";
    const std::string test = withoutScripts(page);
    EXPECT_EQ(count(test, "imes mean little"), 2U) << "below the verdict, and in the table";
    EXPECT_LT(test.find("Times mean little: this program is built for tests (RelWithDebInfo, "
                        "assertions on, what hashphase is compared with optimised less"),
              test.find("</header>"));
    EXPECT_EQ(count(test, "also -Og"), 1U);
    EXPECT_EQ(count(test, "<td>assertions</td><td>on</td>"), 1U);
    EXPECT_EQ(count(test, "<td>AVX2</td>"), 1U);

    page.provenance.buildType = "Release";
    page.provenance.hasAssertions = false;
    page.provenance.programFlags.clear();
    page.provenance.isForMeasuring = true;
    const std::string release = withoutScripts(page);
    EXPECT_EQ(count(release, "mean little"), 0U);
    EXPECT_EQ(count(release, "<td>-O2</td>"), 1U);
    EXPECT_EQ(count(release, "<td>assertions</td><td>off</td>"), 1U);
}

TEST(Page, SaysOnTopHowMuchOfTheProcessorOtherProgramsUsed) {
    const std::string busy =
        "Other programs used 0.8 of 2 cores while this ran: the times may be too long.";
    Page page = samplePage();
    page.provenance.cores = 2;
    EXPECT_EQ(count(withoutScripts(page), "ther programs"), 0U) << "unknown";
    page.provenance.coresOfOthers = 0.25;
    EXPECT_EQ(count(withoutScripts(page), "Other programs"), 0U) << "an eighth of the cores";
    page.provenance.coresOfOthers = 0.8;
    const std::string html = withoutScripts(page);
    EXPECT_LT(html.find(busy), html.find("</header>"));
    EXPECT_EQ(count(html, "<td>cores that other programs used meanwhile</td><td>0.80</td>"), 1U);

    Page joined = samplePage();
    joined.parts = {page, samplePage()};
    const std::string all = withoutScripts(joined);
    EXPECT_EQ(count(all, busy), 1U);
    EXPECT_GT(all.find(busy), all.find("id=\"part-1\""));
    EXPECT_LT(all.find(busy), all.find("id=\"part-1-section-0\""));
    std::ostringstream text;
    printProvenance(page.provenance, text);
    EXPECT_EQ(count(text.str(), busy), 1U) << "on the terminal, too";
    EXPECT_EQ(provenanceJson(page.provenance)["coresOfOthers"], 0.8);
}

TEST(Page, FoldsUpTheSectionsOfItsPartsAndNoOthers) {
    Page page = samplePage();
    page.parts = {samplePage()};
    const std::string html = withoutScripts(page);
    EXPECT_NE(html.find("<section id=\"section-0\">\n<h2>Heading</h2>\n"), std::string::npos);
    EXPECT_NE(html.find("<section id=\"part-1-section-0\">\n<details class=\"fold\">\n<summary>"
                        "<h3>Heading</h3></summary>\n<p>Sentence</p>\n"),
              std::string::npos);
    EXPECT_EQ(count(html, "class=\"fold\""), 1U);
    EXPECT_LT(html.rfind("Verdict"), html.find("class=\"fold\"")) << "seen without unfolding";
}

TEST(Provenance, IsOfADateASystemACommitAndABullet) {
    EXPECT_EQ(utcText(std::chrono::system_clock::time_point(std::chrono::seconds(1'764'421'507))),
              "2025-11-29T13:05:07Z");
    const Provenance provenance = gatherProvenance("command");
    const Json json = provenanceJson(provenance);
    EXPECT_EQ(json["date"].get<std::string>().size(), 20U);
    EXPECT_EQ(json["operatingSystem"], operatingSystem());
    EXPECT_EQ(json["commit"], sourceCommit());
    EXPECT_FALSE(json["commit"].get<std::string>().empty());
    EXPECT_TRUE(json["bulletThreads"].is_boolean());
    EXPECT_EQ(json["bullet"], provenance.bulletVersion) << "as before";

    Provenance known;
    known.date = "2025-11-29T13:05:07Z";
    known.operatingSystem = "Linux 6.1.0 x86_64";
    known.hashphaseVersion = "1.2.3";
    known.commit = "1a2b3c4d-dirty";
    known.bulletVersion = "3.24";
    known.precision = "single";
    known.hasBulletProfileZones = true;
    known.bulletPackage = "libbullet3.24 3.24+dfsg-2";
    const std::string bullet =
        "3.24, single precision, without threads, with profile zones, libbullet3.24 3.24+dfsg-2";
    std::ostringstream text;
    std::ostringstream table;
    printProvenance(known, text);
    writeTable(provenanceTable(known), table);
    for (const char* part : {"1a2b3c4d-dirty", "Linux 6.1.0 x86_64", "2025-11-29T13:05:07Z"}) {
        EXPECT_EQ(count(text.str(), part), 1U) << part;
        EXPECT_EQ(count(table.str(), part), 1U) << part;
    }
    EXPECT_EQ(count(text.str(), bullet), 1U) << text.str();
    EXPECT_EQ(count(table.str(), "<td>" + bullet + "</td>"), 1U) << table.str();
}

// As the library itself does.
TEST(Provenance, SaysWhetherBulletHasProfileZonesAndThreads) {
    const Provenance provenance = gatherProvenance("command");
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broadphase;
    btDiscreteDynamicsWorld world(&dispatcher, &broadphase, nullptr, &configuration);
    EXPECT_EQ(provenance.hasBulletProfileZones,
              !profileZonesOf([&] { world.performDiscreteCollisionDetection(); }).empty());
    EXPECT_EQ(provenance.hasBulletThreads, btCreateDefaultTaskScheduler() != nullptr);
}

TEST(Provenance, TellsAssertionsAndInstructionsOfThisBuildInTextAndJson) {
    const Provenance provenance = gatherProvenance("command");
    EXPECT_EQ(provenance.hasAssertions, HASHPHASE_ENABLE_ASSERTS != 0);
    EXPECT_FALSE(provenance.hasAssertions && provenance.isForMeasuring);
    EXPECT_EQ(provenance.instructionSet, detail::nameOf(detail::instructionSet()));
    const Json json = provenanceJson(provenance);
    EXPECT_EQ(json["assertions"], provenance.hasAssertions);
    EXPECT_EQ(json["forMeasuring"], provenance.isForMeasuring);
    EXPECT_EQ(json["instructionSet"], provenance.instructionSet);
    std::ostringstream text;
    printProvenance(provenance, text);
    EXPECT_EQ(count(text.str(), ", " + provenance.instructionSet + " instructions\n"), 1U);
    EXPECT_EQ(count(text.str(), "Times mean little"), provenance.isForMeasuring ? 0U : 1U);
}

TEST(Page, NeedsNothingElseAndRunsNoScriptButItsOwn) {
    const std::string html = withoutScripts(samplePage());
    EXPECT_EQ(html.find(" src="), std::string::npos);
    EXPECT_EQ(html.find("<link"), std::string::npos);
    for (const char* handler : {" onload=", " onerror=", " onclick=", " onmouseover="}) {
        EXPECT_EQ(html.find(handler), std::string::npos) << handler;
    }
    EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
    const std::string_view hash = chartScripts().hash;
    const std::string charts = hash.empty() ? "" : "'" + std::string(hash) + "' ";
    EXPECT_NE(html.find("script-src " + charts + "'" + policyHash(navigationScript()) + "';"),
              std::string::npos);
}

TEST(Page, HoldsTheTabsOfItsPartsAndAdmitsTheirScripts) {
    Page page = samplePage();
    page.parts = {samplePage()};
    page.parts[0].tabs = {
        {"other", "Other <tab>", "<p>content</p>", "p { margin: 0; }", {"", kNoCode}}};
    const std::string html = withoutScripts(page);
    EXPECT_NE(html.find("aria-controls=\"other\">Other &lt;tab&gt;</button>"), std::string::npos);
    EXPECT_NE(html.find("id=\"other\" aria-labelledby=\"tab-other\">\n<p>content</p></div>"),
              std::string::npos);
    EXPECT_NE(html.find("p { margin: 0; }</style>"), std::string::npos);
    EXPECT_NE(html.find("'sha256-47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU='"),
              std::string::npos);
    EXPECT_NE(html.find("'" + policyHash(navigationScript()) + "'"), std::string::npos);
    EXPECT_EQ(withoutScripts(samplePage()).find("role=\"tab\""), std::string::npos);
}

TEST(Base64, IsThatOfTheStandard) {
    const std::array<std::string, 7> expected{"",         "Zg==",     "Zm8=",    "Zm9v",
                                              "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"};
    const std::string text = "foobar";
    for (std::size_t length = 0; length <= text.size(); ++length) {
        const std::vector<std::uint8_t> bytes(text.begin(),
                                              text.begin() + static_cast<std::ptrdiff_t>(length));
        EXPECT_EQ(base64(bytes), expected[length]);
    }
}

TEST(ChartScripts, AreThereOrSayWhyNot) {
    const ChartScripts scripts = chartScripts();
    EXPECT_NE(scripts.code.empty(), scripts.whyNone.empty());
    EXPECT_EQ(scripts.code.find("</script"), std::string_view::npos);
    EXPECT_EQ(scripts.code.find("<!--"), std::string_view::npos);
}

}  // namespace
}  // namespace hashphase::demos
