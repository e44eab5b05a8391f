// SPDX-License-Identifier: Zlib
#include <demos/compare/report.hpp>

#include <demos/console/format.hpp>
#include <demos/console/table.hpp>
#include <demos/report/report_text.hpp>

#include <algorithm>
#include <cmath>
#include <ostream>

namespace hashphase::demos {
namespace {

const Result* findResult(const Report& report, std::string_view name) {
    const std::vector<Result>& results = report.comparison.results;
    const auto found = std::find_if(results.begin(), results.end(), [name](const Result& result) {
        return result.kind->name == name;
    });
    return found == results.end() ? nullptr : &*found;
}

std::string tallyText(const Result& result, std::size_t FrameVerdict::*count) {
    const Tally tally = tallyOf(result, count);
    std::string text = withThousands(tally.total);
    if (tally.total > 0) {
        text += " (" + withThousands(tally.most) + ")";
    }
    return text;
}

std::string meanPairsText(const Result& result) {
    if (result.rows.empty()) {
        return "-";
    }
    const auto total = static_cast<double>(tallyOf(result, &FrameVerdict::pairs).total);
    return withThousands(
        static_cast<std::uint64_t>(std::llround(total / static_cast<double>(result.rows.size()))));
}

std::string faultText(const Result& result) {
    const Fault& fault = *result.firstFault;
    const std::string first = std::to_string(firstOf(fault.pair));
    const std::string second = std::to_string(secondOf(fault.pair));
    return "NO: '" + std::string(result.kind->name) + "' first " +
           (fault.missing ? "missed" : "reported in excess") + " the pair " + first + ", " +
           second + " in frame " + std::to_string(fault.frame) + "; box " + first + " is " +
           boxText(fault.firstBox) + ", box " + second + " is " + boxText(fault.secondBox);
}

std::string exactnessText(const Report& report) {
    if (report.comparison.framesDone == 0) {
        return "pair sets not verified: no frame was run";
    }
    if (oursWereExact(report) == true) {
        return "pair sets exact in every frame: yes";
    }
    for (const Result& result : report.comparison.results) {
        if (result.kind->ours && result.firstFault) {
            return "pair sets exact in every frame: " + faultText(result);
        }
    }
    return "none of ours took part";
}

bool hasSteps(const Report& report) {
    return std::any_of(report.comparison.results.begin(), report.comparison.results.end(),
                       [](const Result& result) {
                           return !result.rows.empty() && result.rows.front().stepMs.has_value();
                       });
}

void printSetting(const Report& report, std::ostream& out) {
    out << report.scene << ": " << report.description << '\n'
        << withThousands(report.objects) << ' ' << report.noun << ", "
        << report.comparison.framesDone << " frames (the first " << report.comparison.warmUpFrames
        << " verified, not timed), seed " << report.options.sceneSeed() << '\n';
    printProvenance(report.provenance, out);
    if (report.comparison.timeLimitHit) {
        out << "The time limit of " << *report.options.timeLimit << " s was reached after "
            << report.comparison.framesDone << " of " << report.framesAsked << " frames.\n";
    }
    for (const Result& result : report.comparison.results) {
        if (result.leftOutAfter) {
            out << leftOutSentence(report, result) << '\n';
        }
    }
}

}  // namespace

std::optional<double> speedAgainstDbvt(const Report& report, const Result& result) {
    const Result* dbvt = findResult(report, "dbvt");
    const std::optional<Timing> base = dbvt != nullptr ? timingOf(*dbvt) : std::nullopt;
    const std::optional<Timing> own = timingOf(result);
    if (!base || !own || !(own->both.median > 0)) {
        return std::nullopt;
    }
    return base->both.median / own->both.median;
}

std::optional<bool> oursWereExact(const Report& report) {
    std::optional<bool> exact;
    for (const Result& result : report.comparison.results) {
        if (result.kind->ours && !result.rows.empty()) {
            exact = exact.value_or(true) && !result.firstFault;
        }
    }
    return exact;
}

std::string leftOutSentence(const Report& report, const Result& result) {
    if (!result.leftOutAfter) {
        return {};
    }
    return std::string(result.kind->name) + ": left out, filling " + withThousands(report.objects) +
           " " + report.noun + " was not done within " + fixed(*result.leftOutAfter, 1) + " s.";
}

std::string verdictLine(const Report& report) {
    std::string line = withThousands(report.objects) + " " + report.noun + ", " +
                       std::to_string(report.comparison.framesDone) + " frames";
    const char* separator = ": ";
    for (const std::string_view name : {"hash", "dbvt"}) {
        const Result* result = findResult(report, name);
        const std::optional<Timing> timing = result != nullptr ? timingOf(*result) : std::nullopt;
        if (timing) {
            line += separator + std::string(result->kind->title) + " " +
                    milliseconds(timing->both.median) + " ms" + (name == "hash" ? " a frame" : "");
            separator = ", ";
        }
    }
    const Result* hash = findResult(report, "hash");
    const std::optional<double> ratio =
        hash != nullptr ? speedAgainstDbvt(report, *hash) : std::nullopt;
    if (ratio) {
        line += ", " + fixed(*ratio, 1) + "x";
    }
    return line + "; " + exactnessText(report);
}

void printReport(const Report& report, std::ostream& out) {
    printSetting(report, out);
    const bool steps = hasSteps(report);
    const std::vector<Result>& results = report.comparison.results;
    const bool removes = std::any_of(results.begin(), results.end(), [](const Result& result) {
        return result.removeMs.has_value();
    });
    out << "\nTimes in ms a frame: median (5th-95th percentile). Speed: against dbvt, by setAabb + "
           "calculate.\nPairs: mean of all frames. Missing, extra and stale pairs: sum of all "
           "frames (most in one).\nFill: ms to make the broadphase and create all objects in it.";
    if (removes) {
        out << " Remove: ms to destroy " << withThousands(report.comparison.objectsRemoved)
            << " of them at the end.";
    }
    out << "\n\n";
    std::vector<std::string> header{"broadphase", "setAabb for all", "calculate", "both", "speed"};
    if (steps) {
        header.emplace_back("whole step");
    }
    for (const char* column : {"pairs", "missing", "extra", "stale", "memory", "fill"}) {
        header.emplace_back(column);
    }
    if (removes) {
        header.emplace_back("remove");
    }
    Table table(header);
    for (const Result& result : results) {
        const std::optional<Timing> timing = timingOf(result);
        const auto text = [&timing](Spread Timing::*part) {
            return spreadText(timing ? std::optional((*timing).*part) : std::nullopt);
        };
        std::vector<std::string> cells{std::string(result.kind->name), text(&Timing::setAabb),
                                       text(&Timing::calculate), text(&Timing::both),
                                       ratioText(speedAgainstDbvt(report, result))};
        if (steps) {
            cells.push_back(spreadText(timing ? timing->step : std::nullopt));
        }
        cells.push_back(meanPairsText(result));
        for (std::size_t FrameVerdict::*count :
             {&FrameVerdict::missing, &FrameVerdict::extra, &FrameVerdict::stale}) {
            cells.push_back(result.rows.empty() ? "-" : tallyText(result, count));
        }
        cells.push_back(result.memoryBytes ? byteSize(*result.memoryBytes)
                                           : (result.leftOutAfter ? "-" : "n/a"));
        cells.push_back(result.fillMs ? milliseconds(*result.fillMs) : "-");
        if (removes) {
            cells.push_back(result.removeMs ? milliseconds(*result.removeMs) : "-");
        }
        table.addRow(std::move(cells));
    }
    table.print(out);
    out << '\n' << verdictLine(report) << '\n';
}

}  // namespace hashphase::demos
