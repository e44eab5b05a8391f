// SPDX-License-Identifier: Zlib
#include <demos/try/try_comparison.hpp>

#include <demos/console/format.hpp>
#include <demos/console/table.hpp>
#include <demos/report/report_text.hpp>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

namespace hashphase::demos {
namespace {

std::string ms(double number) {
    return milliseconds(number);
}

std::string count(double number) {
    return number < 100 && number != std::floor(number)
               ? fixed(number, 1)
               : withThousands(static_cast<std::uint64_t>(std::llround(number)));
}

std::string percent(double share) {
    return std::isfinite(share) ? fixed(100 * share, share < 0.1 ? 1 : 0) + " %" : "-";
}

std::string times(double stock, double ours) {
    return ours > 0 ? ratioText(stock / ours) : "-";
}

std::string orDash(const std::optional<double>& number, std::string (*text)(double)) {
    return number ? text(*number) : "-";
}

// --- The verdict ---------------------------------------------------------------------------------

// "6.37 ms less in the broadphase"; empty where the two round to the same.
std::string changeText(double stock, double ours, const std::string& where) {
    const std::string change = ms(std::abs(stock - ours));
    return change == ms(0) ? "" : change + " ms " + (ours > stock ? "more " : "less ") + where;
}

std::string narrowPhaseText(const StepSummary& stock, const StepSummary& ours) {
    if (!stock.narrowPhase || !ours.narrowPhase) {
        return "";
    }
    const std::string where = "in the narrow phase";
    const std::string text = changeText(*stock.narrowPhase, *ours.narrowPhase, where);
    const double saved = stock.stalePairCount().value_or(0) - ours.stalePairCount().value_or(0);
    if (saved < 1) {
        return text;
    }
    return (text.empty() ? "as long " + where : text) + ", which visits " + count(ours.pairCount) +
           " pairs instead of " + count(stock.pairCount) + ", " + count(saved) +
           " of which do not overlap";
}

// What the change of a step consists of.
std::string changesText(const StepSummary& stock, const StepSummary& ours) {
    const auto elsewhere = [](const StepSummary& summary) {
        return *summary.step - summary.broadphase() - summary.narrowPhase.value_or(0);
    };
    std::vector<std::string> parts{
        changeText(stock.broadphase(), ours.broadphase(), "in the broadphase"),
        narrowPhaseText(stock, ours), changeText(elsewhere(stock), elsewhere(ours), "elsewhere")};
    std::erase(parts, "");
    std::string text;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        text += (i == 0 ? ": " : i + 1 < parts.size() ? ", " : ", and ") + parts[i];
    }
    return text;
}

// Which times to trust where its thread was kept from working, by others or by what it waits for.
std::string trustText(const StepComparison& steps) {
    if (steps.onThreads) {
        return "Trust the times of updateAabbs and calculateOverlappingPairs, and not those on the "
               "wall.";
    }
    const StepSummary& stock = steps.stock;
    const StepSummary& ours = steps.ours;
    if (!stock.step || !ours.step) {
        return "Trust the times above.";
    }
    return "Trust the times above, and not those by the clock on the wall: " +
           ms(stock.stepOnWall) + " and " + ms(ours.stepOnWall) + " ms a step (" +
           times(stock.stepOnWall, ours.stepOnWall) + ").";
}

void printHowBusy(const StepComparison& steps, const Provenance& machine, std::ostream& out) {
    constexpr double kUndisturbed = 0.9;
    const double shareOfStock = steps.stock.processorShare;
    const double shareOfOurs = steps.ours.processorShare;
    const std::string overload = overloadText(machine);
    const bool isDisturbed = std::min(shareOfStock, shareOfOurs) < kUndisturbed;
    if (overload.empty() && !isDisturbed) {
        return;
    }
    out << (overload.empty() ? "Other programs were busy, or the program waited for something"
                             : "Other programs kept the processor busy (" + overload + ")");
    if (isDisturbed) {
        out << ": the calling thread had it for " << percent(shareOfStock)
            << " of the time with Bullet's, and for " << percent(shareOfOurs) << " with hashphase. "
            << trustText(steps) << '\n';
    } else {
        out << (steps.onThreads ? ", which lengthens the times on the wall.\n"
                                : ", which these times are without.\n");
    }
}

void printCautions(const StepComparison& steps, std::ostream& out) {
    const StepSummary& stock = steps.stock;
    const StepSummary& ours = steps.ours;
    if (steps.isCut) {
        out << "Compared are the first steps, as many as both runs have: with Bullet's broadphase "
               "there were "
            << withThousands(steps.allOfStock) << ", with hashphase "
            << withThousands(steps.allOfOurs) << ".\n";
    }
    constexpr double kLargeShare = 0.2;
    if (std::max(stock.slowestShare, ours.slowestShare) > kLargeShare) {
        out << "Times are without the slowest twentieth of the steps, which took "
            << percent(stock.slowestShare) << " of all time with Bullet's and "
            << percent(ours.slowestShare) << " with hashphase: " << ms(stock.slowest) << " and "
            << ms(ours.slowest) << " ms a step.\n";
    }
    constexpr std::size_t kFew = 60;
    if (stock.stepCount < kFew) {
        out << "These are few steps: take the figures as a hint.\n";
    }
    if (stock.objectCount != ours.objectCount) {
        out << "The numbers of objects differ: the program does not do the same each time.\n";
    }
}

}  // namespace

void printStepTable(const StepComparison& steps, std::ostream& out) {
    const StepSummary& stock = steps.stock;
    const StepSummary& ours = steps.ours;
    Table table({"a step", "Bullet's", "hashphase", "ratio"});
    const auto timeRow = [&](const char* name, double a, double b) {
        table.addRow({name, ms(a), ms(b), times(a, b)});
    };
    const auto countRow = [&](const char* name, double a, double b) {
        table.addRow({name, count(a), count(b), ""});
    };
    timeRow("updateAabbs [ms]", stock.updateAabbs, ours.updateAabbs);
    timeRow("calculateOverlappingPairs [ms]", stock.calculate, ours.calculate);
    timeRow("rays, with what they hit [ms]", stock.rays, ours.rays);
    timeRow("these together [ms]", stock.broadphase(), ours.broadphase());
    if (stock.narrowPhase || ours.narrowPhase) {
        timeRow("narrow phase [ms]", stock.narrowPhase.value_or(0), ours.narrowPhase.value_or(0));
    }
    if (stock.step && ours.step) {
        timeRow("whole step [ms]", *stock.step, *ours.step);
        table.addRow({"share of the broadphase", percent(stock.broadphase() / *stock.step),
                      percent(ours.broadphase() / *ours.step), ""});
    }
    countRow("pairs", stock.pairCount, ours.pairCount);
    table.addRow({"of which overlap", orDash(stock.truePairCount, count),
                  orDash(ours.truePairCount, count), ""});
    countRow("rays", stock.rayCount, ours.rayCount);
    if (stock.rayBetweenCount + ours.rayBetweenCount > 0) {
        countRow("rays between steps", stock.rayBetweenCount, ours.rayBetweenCount);
        timeRow("these, with what they hit [ms]", stock.raysBetween, ours.raysBetween);
    }
    countRow("objects at most", stock.objectCount, ours.objectCount);
    countRow("steps", static_cast<double>(stock.stepCount), static_cast<double>(ours.stepCount));
    table.print(out);
    out << (steps.onThreads
                ? "Times are the calling thread's processor time; of the narrow phase, rays and "
                  "whole steps, in which several threads work, they are those on the wall.\n"
                : "Times are the calling thread's processor time.\n");
}

void printVerdict(const StepComparison& steps, const Provenance& machine, std::ostream& out) {
    printCautions(steps, out);
    const std::optional<double>& stock = steps.stock.step;
    const std::optional<double>& ours = steps.ours.step;
    if (stock && ours) {
        out << "With hashphase a step takes " << ms(*ours) << " ms instead of " << ms(*stock)
            << " (" << times(*stock, *ours) << ")" << changesText(steps.stock, steps.ours) << ".\n";
    } else {
        out << "The program has made no steps: pairs were calculated by hand.\n";
    }
    printHowBusy(steps, machine, out);
}

void printNotCompared(const Trial& trial, std::ostream& out) {
    const std::vector<tryout::StepRow>& rows = trial.runs.front().rows;
    if (trial.runs.size() > 1 || rows.empty()) {
        out << "No steps were compared: the runs have none in common in which pairs were "
               "calculated.\n";
        return;
    }
    const StepSummary stock = summaryOf(rows, isOnThreads(rows));
    out << "There was no run with hashphase. With Bullet's broadphase, " << ms(stock.broadphase())
        << " ms of a step";
    if (stock.step) {
        out << " of " << ms(*stock.step) << " ms";
    }
    out << " were updateAabbs, calculateOverlappingPairs and rays; "
        << withThousands(stock.stepCount) << " steps, " << count(stock.objectCount)
        << " objects at most, " << count(stock.pairCount) << " pairs.\n";
}

}  // namespace hashphase::demos
