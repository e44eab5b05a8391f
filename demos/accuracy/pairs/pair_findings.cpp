// SPDX-License-Identifier: Zlib
#include <demos/accuracy/pairs/pair_findings.hpp>

#include <demos/accuracy/binomial.hpp>
#include <demos/console/format.hpp>

namespace hashphase::demos {
namespace {

double shareOf(std::uint64_t part, std::uint64_t whole) {
    return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

std::vector<DataColumn> pairColumns() {
    return {{"ns", "time [ns/object]"},
            {"speed", "times as fast as btDbvtBroadphase"},
            {"true_pairs", "true pairs judged"},
            {"missed", "missed pairs"},
            {"missed_share", "missed share of the true pairs"},
            {"missed_low", "at least"},
            {"missed_high", "at most (95 %)"},
            {"false", "false pairs"},
            {"false_share", "false pairs a true pair"}};
}

Value valueOf(std::optional<double> number) {
    Value value;
    if (number) {
        value = *number;
    }
    return value;
}

std::vector<Value> pairValues(const PairMeasurement& measured, std::optional<double> nanoseconds,
                              std::optional<double> bulletNanoseconds) {
    const ShareInterval interval =
        measured.truePairs > 0
            ? intervalOverFrames(measured.missed, measured.truePairs, measured.judgedFrames)
            : ShareInterval{};
    std::optional<double> speed;
    if (nanoseconds && bulletNanoseconds) {
        speed = *bulletNanoseconds / *nanoseconds;
    }
    return {valueOf(nanoseconds),
            valueOf(speed),
            static_cast<double>(measured.truePairs),
            static_cast<double>(measured.missed),
            missedShare(measured),
            interval.low,
            interval.high,
            static_cast<double>(measured.extra),
            extraShare(measured)};
}

double missedShare(const PairMeasurement& measured) {
    return shareOf(measured.missed, measured.truePairs);
}

double extraShare(const PairMeasurement& measured) {
    return shareOf(measured.extra, measured.truePairs);
}

std::string percentText(double share) {
    return valueText(100 * share) + " %";
}

std::string pairResultText(const PairMeasurement& measured) {
    if (measured.missed == 0 && measured.extra == 0) {
        return "exactly the overlapping pairs";
    }
    const std::string missed =
        measured.missed == 0 ? "misses none"
                             : "misses " + percentText(missedShare(measured)) + " of the pairs";
    return missed + (measured.extra == 0
                         ? ", none is false"
                         : ", lists " + percentText(extraShare(measured)) + " too many");
}

void PairChecks::Sum::add(const PairMethod& method, const PairMeasurement& measured, bool isWrong) {
    ++ways;
    truePairs += measured.truePairs;
    missed += measured.missed;
    extra += measured.extra;
    if (isWrong && firstWrong.empty()) {
        firstWrong = "; first " + method.name;
    }
}

std::string PairChecks::Sum::evidence() const {
    return withThousands(missed) + " missed and " + withThousands(extra) + " false of " +
           withThousands(truePairs) + " pairs in " + std::to_string(ways) + " runs" + firstWrong;
}

void PairChecks::take(std::span<const PairMethod> methods, const PairTrial& trial) {
    for (std::size_t i = 0; i < methods.size(); ++i) {
        const PairMeasurement& measured = trial.measurements[i];
        const bool misses = measured.missed > 0;
        if (methods[i].isExact) {
            exact_.add(methods[i], measured, misses || measured.extra > 0);
        } else if (methods[i].isComplete) {
            complete_.add(methods[i], measured, misses);
        }
    }
    framesByBruteForce_ += trial.framesByBruteForce;
    framesThatDiffer_ += trial.framesThatDiffer;
}

std::vector<Check> PairChecks::checks() const {
    std::vector<Check> checks;
    checks.push_back({"Every exact way lists all overlapping pairs and no other",
                      exact_.missed == 0 && exact_.extra == 0 && exact_.truePairs > 0,
                      exact_.evidence()});
    if (complete_.ways > 0) {
        checks.push_back(
            {"Ways that may list too many miss none", complete_.missed == 0, complete_.evidence()});
    }
    checks.push_back({"The sweep that tells the true pairs agrees with brute force",
                      framesByBruteForce_ > 0 && framesThatDiffer_ == 0,
                      std::to_string(framesThatDiffer_) + " of " +
                          std::to_string(framesByBruteForce_) +
                          " frames of up to 20,000 objects differ"});
    return checks;
}

}  // namespace hashphase::demos
