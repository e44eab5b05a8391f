// SPDX-License-Identifier: Zlib
#include <demos/accuracy/sweeps/sweep_experiment.hpp>

#include <demos/console/format.hpp>

namespace hashphase::demos {
namespace {

std::string ofText(std::uint64_t part, std::uint64_t whole) {
    return withThousands(part) + " of " + withThousands(whole);
}

/// Evidence and whether it holds, method by method.
struct MethodCounts {
    bool holds = true;
    std::string evidence;

    void add(const SweepMethod& method, const std::string& text, bool methodHolds) {
        holds &= methodHolds;
        evidence += (evidence.empty() ? "" : "; ") + method.name + ": " + text;
    }
};

Check missesCheck(const SweepResults& results) {
    MethodCounts counts;
    for (std::size_t i = 0; i < results.methods.size(); ++i) {
        const SweepTally total = totalOf(results, i);
        if (results.methods[i].missesNothing) {
            counts.add(results.methods[i], ofText(total.missed, total.contacts), total.missed == 0);
        }
    }
    return {"Methods that promise every contact miss none", counts.holds, counts.evidence};
}

Check inventsCheck(const SweepResults& results) {
    MethodCounts counts;
    for (std::size_t i = 0; i < results.methods.size(); ++i) {
        const SweepTally total = totalOf(results, i);
        if (results.methods[i].inventsNothing) {
            counts.add(results.methods[i], withThousands(total.invented), total.invented == 0);
        }
    }
    return {"Methods that promise contacts only list no other pairs", counts.holds,
            counts.evidence};
}

Check likenessCheck(const SweepResults& results) {
    MethodCounts counts;
    bool isFirst = true;
    for (std::size_t i = 0; i < results.methods.size(); ++i) {
        const SweepMethod& method = results.methods[i];
        if (!method.isExact() || method.oneFrameIn != 1) {
            continue;
        }
        const SweepTally total = totalOf(results, i);
        counts.add(method,
                   isFirst ? "what the others are compared with"
                           : ofText(total.framesUnlike, total.frames) + " frames differ",
                   total.framesUnlike == 0);
        isFirst = false;
    }
    return {"Exact methods list the same pairs, frame by frame", counts.holds, counts.evidence};
}

// Rounded to double, a time is off by a few parts in 2^53.
Check timesCheck(const SweepResults& results) {
    constexpr double kRounding = 1e-15;
    MethodCounts counts;
    for (std::size_t i = 0; i < results.methods.size(); ++i) {
        const SweepTally total = totalOf(results, i);
        if (results.methods[i].contactTime) {
            counts.add(results.methods[i],
                       valueText(total.worstRelativeTimeError) + " at worst in " +
                           withThousands(total.timesAsked),
                       total.worstRelativeTimeError <= kRounding);
        }
    }
    return {"Times of contact are true but for the rounding to double, 1e-15 of them", counts.holds,
            counts.evidence};
}

// Of intervals that hold the truth in 95 of 100 cases, 15 of 100 fail next to never.
Check theoryCheck(const SweepResults& results) {
    constexpr double kShareWithin = 0.85;
    MethodCounts counts;
    counts.holds = !results.points.empty();
    for (std::size_t i = 0; i < results.methods.size(); ++i) {
        if (!results.methods[i].isDiscrete) {
            continue;
        }
        std::uint64_t within = 0;
        for (const TunnellingPoint& point : results.points) {
            const SweepTally& tally = point.tallies[i];
            const ShareInterval share = wilsonInterval(tally.detected(), tally.contacts);
            within += share.contains(point.detectedInTheory()) ? 1 : 0;
        }
        const auto points = static_cast<double>(results.points.size());
        counts.add(results.methods[i], ofText(within, results.points.size()) + " points",
                   static_cast<double>(within) >= kShareWithin * points);
    }
    return {
        "Discrete detection lies on the line min(1, (T + 2r) / (v dt)): the 95 % intervals of at "
        "least 85 % of the points hold it",
        counts.holds, counts.evidence};
}

}  // namespace

std::vector<Check> sweepChecks(const SweepResults& results) {
    return {theoryCheck(results), missesCheck(results), inventsCheck(results),
            likenessCheck(results), timesCheck(results)};
}

}  // namespace hashphase::demos
