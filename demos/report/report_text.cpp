// SPDX-License-Identifier: Zlib
#include <demos/report/report_text.hpp>

#include <demos/console/columns.hpp>
#include <demos/console/format.hpp>
#include <demos/console/program.hpp>
#include <demos/system/interruption.hpp>

#include <algorithm>
#include <ostream>
#include <sstream>
#include <utility>

namespace hashphase::demos {
namespace {

/// "3.24, single precision, without threads, with profile zones, libbullet3.24 3.24+dfsg-2"
std::string bulletText(const Provenance& provenance) {
    const auto with = [](bool has) { return std::string(has ? ", with " : ", without "); };
    return provenance.bulletVersion + ", " + provenance.precision + " precision" +
           with(provenance.hasBulletThreads) + "threads" + with(provenance.hasBulletProfileZones) +
           "profile zones" +
           (provenance.bulletPackage.empty() ? "" : ", " + provenance.bulletPackage);
}

}  // namespace

std::string ratioText(const std::optional<double>& ratio) {
    return ratio ? fixed(*ratio, *ratio < 10 ? 2 : 1) + "x" : "-";
}

std::string namesText(const std::string& opening, const std::vector<std::string>& names) {
    constexpr std::size_t mostNames = 10;
    std::string text;
    for (std::size_t i = 0; i < std::min(names.size(), mostNames); ++i) {
        text += (i == 0 ? opening : ", ") + names[i];
    }
    if (names.size() > mostNames) {
        text += " and " + std::to_string(names.size() - mostNames) + " more";
    }
    return text;
}

std::string leftOutText(const std::vector<std::string>& names) {
    return isInterrupted() ? "; interrupted" + namesText(", which left out ", names)
                           : namesText("; left out for want of time: ", names);
}

std::string interruptionText() {
    return isInterrupted() ? "The run was interrupted: what it measured until then is here." : "";
}

std::string boxText(const Aabb<float>& box) {
    std::ostringstream text;
    text.precision(9);
    text << '[' << box.min().x() << ' ' << box.min().y() << ' ' << box.min().z() << " to "
         << box.max().x() << ' ' << box.max().y() << ' ' << box.max().z() << ']';
    return text.str();
}

DataTable provenanceTable(const Provenance& provenance) {
    std::string flags = provenance.compilerFlags.empty() ? "unknown" : provenance.compilerFlags;
    if (!provenance.compilerFlags.empty() && !provenance.programFlags.empty()) {
        flags +=
            "; what hashphase is compared with, but Bullet's own library, and what times it: "
            "also " +
            provenance.programFlags;
    }
    DataTable table{{{"what"}, {"value"}},
                    {{"date (UTC)", provenance.date},
                     {"hashphase", provenance.hashphaseVersion + ", commit " + provenance.commit},
                     {"Bullet", bulletText(provenance)},
                     {"compiler", provenance.compiler},
                     {"its flags", flags},
                     {"build", provenance.buildType + (provenance.isForMeasuring
                                                           ? ", for measuring"
                                                           : ", for tests: times mean little")},
                     {"assertions", provenance.hasAssertions ? "on" : "off"},
                     {"operating system", provenance.operatingSystem},
                     {"processor", provenance.cpu},
                     {"instructions that hashphase uses", provenance.instructionSet},
                     {"cores", std::to_string(provenance.cores)}}};
    if (provenance.coresOfOthers) {
        table.add(
            {"cores that other programs used meanwhile", fixed(*provenance.coresOfOthers, 2)});
    }
    table.add({"command", provenance.commandLine});
    return table;
}

std::string overloadText(const Provenance& provenance) {
    // Programs that measure need one core or two, and memory. A desktop at rest, and another program on one of many
    // cores, hardly lengthen times; a quarter of a core on a machine of two does.
    constexpr double kMostShare = 0.125;
    const double others = provenance.coresOfOthers.value_or(0);
    return others > kMostShare * provenance.cores
               ? "Other programs used " + fixed(others, 1) + " of " +
                     std::to_string(provenance.cores) +
                     (provenance.cores == 1 ? " core" : " cores") + " while this ran"
               : std::string();
}

std::string overloadSentence(const Provenance& provenance) {
    const std::string overload = overloadText(provenance);
    return overload.empty() ? overload : overload + ": the times may be too long.";
}

std::vector<std::string> cautionsOf(const Provenance& provenance) {
    std::vector<std::string> cautions;
    if (!provenance.isForMeasuring) {
        cautions.push_back("Times mean little: this program is built for tests (" +
                           provenance.buildType + ", assertions " +
                           (provenance.hasAssertions ? "on" : "off") +
                           (provenance.programFlags.empty()
                                ? ""
                                : ", what hashphase is compared with optimised less than "
                                  "hashphase itself") +
                           "). Measure with the build that demos/run makes.");
    }
    if (std::string overload = overloadSentence(provenance); !overload.empty()) {
        cautions.push_back(std::move(overload));
    }
    return cautions;
}

void printProvenance(const Provenance& provenance, std::ostream& out) {
    out << "hashphase " << provenance.hashphaseVersion << " (" << provenance.commit << "), "
        << provenance.compiler << ", " << provenance.cpu << ", " << provenance.cores
        << " cores, one thread, " << provenance.instructionSet << " instructions\n"
        << "Bullet " << bulletText(provenance) << "; " << provenance.operatingSystem << ", "
        << provenance.date << '\n';
    for (const std::string& caution : cautionsOf(provenance)) {
        out << caution << '\n';
    }
}

void printProvenance(const Provenance& provenance, const Console& console) {
    std::ostringstream text;
    printProvenance(provenance, text);
    console.out << wrapped(text.str(), lineWidth(console));
}

void printSentences(const std::vector<std::string>& sentences, const Console& console) {
    for (const std::string& sentence : sentences) {
        console.out << wrapped(sentence, lineWidth(console)) << '\n';
    }
}

void printVerdict(const std::string& verdict, const Console& console) {
    console.out << (console.columns == 0 ? verdict : wrapped(verdict, lineWidth(console))) << '\n';
}

}  // namespace hashphase::demos
