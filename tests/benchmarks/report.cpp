// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/report.hpp>

#include <demos/console/format.hpp>
#include <demos/console/table.hpp>
#include <demos/report/report_text.hpp>
#include <tests/benchmarks/cell_size.hpp>
#include <tests/benchmarks/effects_overhead.hpp>
#include <tests/benchmarks/effects_workload.hpp>

#include <algorithm>
#include <cmath>
#include <ostream>

namespace hashphase::benchmarks {
namespace {

using demos::fixed;
using demos::ratioText;
using demos::Table;
using demos::withThousands;

constexpr double kNanosecondsPerMillisecond = 1e6;

std::string perOperation(const CaseResult& result, const ContestantResult& contestant) {
    const std::optional<demos::Spread> spread = contestant.spread();
    if (!spread) {
        return contestant.droppedOut ? "too slow" : "-";
    }
    const double ns = spread->median * kNanosecondsPerMillisecond /
                      static_cast<double>(std::max<std::size_t>(result.operations, 1));
    return fixed(ns, ns < 9.95 ? 2 : ns < 99.5 ? 1 : 0);
}

std::string perFrame(std::uint64_t total, const AnswerTally& tally) {
    if (tally.framesChecked == 0) {
        return "-";
    }
    const double mean = static_cast<double>(total) / tally.framesChecked;
    return mean > 0 && mean < 9.95 ? fixed(mean, 1)
                                   : withThousands(static_cast<std::uint64_t>(std::llround(mean)));
}

std::string heapText(const CaseResult& result, const ContestantResult& contestant) {
    if (!contestant.memory.heapBytes) {
        return "-";
    }
    return fixed(static_cast<double>(*contestant.memory.heapBytes) /
                     static_cast<double>(std::max<std::size_t>(result.objects, 1)),
                 0);
}

std::string ownText(const CaseResult& result, const ContestantResult& contestant) {
    const AnswerTally& tally = contestant.tally;
    if (!contestant.memory.own || tally.framesChecked == 0) {
        return "-";
    }
    const double pairs = static_cast<double>(tally.answers) / tally.framesChecked;
    const auto each = [](std::size_t bytes, double count) {
        return count > 0 ? fixed(static_cast<double>(bytes) / count, 0) : std::string("-");
    };
    return each(contestant.memory.own->forObjects, static_cast<double>(result.objects)) + " + " +
           each(contestant.memory.own->forPairs, pairs);
}

// The fastest of those that are not ours, the baseline included.
const ContestantResult* fastestOther(const CaseResult& result) {
    const ContestantResult* fastest = nullptr;
    for (const ContestantResult& contestant : result.contestants) {
        const std::optional<demos::Spread> spread = contestant.spread();
        if (!contestant.kind.ours && spread &&
            (fastest == nullptr || spread->median < fastest->spread()->median)) {
            fastest = &contestant;
        }
    }
    return fastest;
}

void printOverview(const BenchmarkReport& report, std::ostream& out) {
    Table table(
        {"case", "exact", "hash ns", "hash / dbvt", "grid / dbvt", "fastest other", "hash / that"});
    for (const CaseResult& result : report.cases) {
        const ContestantResult* hash = result.find("hash");
        const ContestantResult* grid = result.find("grid");
        const ContestantResult* dbvt = result.find(kBaseline);
        const ContestantResult* other = fastestOther(result);
        // Among the sweeps, `hash` is told nothing of the motions.
        const bool missesByDesign = hash != nullptr && !hash->kind.ours;
        const bool hasItsOwnTable = result.group == kCellSizeGroup || result.group == kEffectsGroup;
        if (hasItsOwnTable || missesByDesign) {
            continue;
        }
        const auto speed = [](const ContestantResult* than, const ContestantResult* own) {
            return ratioText(own == nullptr ? std::nullopt : speedAgainst(than, *own));
        };
        const char* exact = result.oursWereExact() ? "yes" : "NO";
        table.addRow({result.name, exact, hash == nullptr ? "-" : perOperation(result, *hash),
                      speed(dbvt, hash), speed(dbvt, grid),
                      other == nullptr ? "-" : other->kind.name, speed(other, hash)});
    }
    out << "How many times faster than each: the median over the frames of the ratio of both times "
           "in the same frame.\n\n";
    table.print(out);
    out << '\n';
}

void printRandomSpread(const BenchmarkReport& report, std::ostream& out) {
    std::vector<double> ratios;
    for (const CaseResult& result : report.cases) {
        const ContestantResult* hash = result.find("hash");
        if (result.group != "random" || hash == nullptr) {
            continue;
        }
        const double speed = speedAgainst(result.find(kBaseline), *hash).value_or(0);
        if (speed > 0) {
            ratios.push_back(speed);
        }
    }
    if (ratios.empty()) {
        return;
    }
    std::sort(ratios.begin(), ratios.end());
    out << "Random scenes: hash was " << ratioText(demos::spreadOf(ratios).median)
        << " dbvt in the median of " << ratios.size() << ", " << ratioText(ratios.front())
        << " in the worst, " << ratioText(ratios.back()) << " in the best.\n";
}

std::string percentText(double share) {
    return fixed(100 * share, 1) + " %";
}

void printRegrets(const BenchmarkReport& report, std::ostream& out) {
    Table table({"case", "automatic ns", "best fixed", "its ns", "regret"});
    std::vector<double> regrets;
    for (const CaseResult& result : report.cases) {
        if (const std::optional<CellSizeRegret> regret = cellSizeRegret(result)) {
            regrets.push_back(regret->regret);
            table.addRow({result.name, perOperation(result, *result.find(kAutomaticCells)),
                          regret->bestFixed, perOperation(result, *result.find(regret->bestFixed)),
                          percentText(regret->regret)});
        }
    }
    if (regrets.empty()) {
        return;
    }
    out << "Cell sizes, fixed ones in mean edges. Regret: how much longer the automatic ones took "
           "than the best fixed one.\n\n";
    table.print(out);
    out << "\nRegret: median " << percentText(demos::spreadOf(regrets).median) << ", worst "
        << percentText(*std::max_element(regrets.begin(), regrets.end())) << " of "
        << regrets.size() << " cases.\n\n";
}

void printEffectsOverheads(const BenchmarkReport& report, std::ostream& out) {
    Table table({"case", "contestant", "frames", "/ by-hand", "5 %", "95 %", "bound", "holds"});
    bool isEmpty = true;
    for (const CaseResult& result : report.cases) {
        for (const EffectsOverhead& overhead : effectsOverheads(result)) {
            isEmpty = false;
            const demos::Spread& ratio = overhead.ratio;
            table.addRow({result.name, overhead.contestant, std::to_string(result.framesDone),
                          fixed(ratio.median, 4), fixed(ratio.low, 4), fixed(ratio.high, 4),
                          overhead.bound ? fixed(*overhead.bound, 2) : "-",
                          !overhead.bound    ? "-"
                          : overhead.holds() ? "yes"
                                             : "NO"});
        }
    }
    if (isEmpty) {
        return;
    }
    out << "Effects: how many times as long as by hand the same frame took, the median over the "
           "frames and the 5th and 95th percentile.\n\n";
    table.print(out);
    out << '\n';
}

}  // namespace

void printSetting(const BenchmarkReport& report, const std::vector<ContestantKind>& kinds,
                  std::ostream& out) {
    demos::printProvenance(report.provenance, out);
    out << "Our compiler flags: " << report.provenance.compilerFlags << '\n';
    for (const ContestantKind& kind : kinds) {
        out << "  " << kind.name
            << std::string(16 - std::min<std::size_t>(kind.name.size(), 15), ' ') << kind.title
            << " (" << kind.package << ")\n";
    }
    if (report.options.quick) {
        out << "QUICK: scenes so small and frames so few that the times mean nothing.\n";
    }
    out << '\n'
        << report.settings.frames << " different frames"
        << (report.options.frames || report.options.quick
                ? ""
                : " (" + std::to_string(MeasurementSettings::kFramesOfSmall) + " up to " +
                      withThousands(MeasurementSettings::kSmall) + " objects)")
        << " after " << report.settings.warmUpFrames
        << " to warm up, the contestants in turn in each; seed " << report.options.seed << ".\n"
        << "Times: median (5th-95th percentile). Answers, missing, extra and twice: mean of a "
           "frame.\nHeap: bytes an object. Own: bytes an object + a pair by our own account.\n\n";
}

void printCase(const CaseResult& result, std::ostream& out) {
    out << result.name << ": " << result.description << '\n';
    if (result.timeLimitHit) {
        out << "The time limit was reached after " << result.framesDone << " frames.\n";
    }
    Table table({"contestant", "ms a frame", "ns/" + result.operation, "/ dbvt", "answers",
                 "missing", "extra", "twice", "heap", "own"});
    for (const ContestantResult& contestant : result.contestants) {
        const AnswerTally& tally = contestant.tally;
        table.addRow({contestant.kind.name, demos::spreadText(contestant.spread()),
                      perOperation(result, contestant),
                      ratioText(speedAgainst(result.find(kBaseline), contestant)),
                      perFrame(tally.answers, tally), perFrame(tally.missing, tally),
                      perFrame(tally.extra, tally), perFrame(tally.duplicates, tally),
                      heapText(result, contestant), ownText(result, contestant)});
    }
    table.print(out);
    for (const ContestantResult& contestant : result.contestants) {
        if (contestant.kind.ours && !contestant.firstFault.empty()) {
            out << "WRONG: '" << contestant.kind.name << "' " << contestant.firstFault << '\n';
        }
    }
    out << std::endl;
}

void printSummary(const BenchmarkReport& report, std::ostream& out) {
    printOverview(report, out);
    printRandomSpread(report, out);
    printRegrets(report, out);
    printEffectsOverheads(report, out);
    if (report.cases.size() < report.casesAsked) {
        out << "The time limit left out " << report.casesAsked - report.cases.size() << " of "
            << report.casesAsked << " cases.\n";
    }
    out << "All answers of ours exact: " << (oursWereExact(report) ? "yes" : "NO") << '\n';
}

bool oursWereExact(const BenchmarkReport& report) {
    return std::all_of(report.cases.begin(), report.cases.end(),
                       [](const CaseResult& result) { return result.oursWereExact(); });
}

}  // namespace hashphase::benchmarks
