// SPDX-License-Identifier: Zlib
#pragma once

// What was measured of ways to find pairs, in rows, checks and words.

#include <demos/accuracy/experiment.hpp>
#include <demos/accuracy/pairs/pair_trial.hpp>

namespace hashphase::demos {

/// Time, and missed and false pairs, each with their share of the true pairs.
[[nodiscard]] std::vector<DataColumn> pairColumns();

/// A row for pairColumns(), from times [ns/object] where they were taken.
[[nodiscard]] std::vector<Value> pairValues(const PairMeasurement& measured,
                                            std::optional<double> nanoseconds,
                                            std::optional<double> bulletNanoseconds);

/// The missed ones by the true pairs; 0 where there are none.
[[nodiscard]] double missedShare(const PairMeasurement& measured);

/// The false ones by the true pairs: 1 means that half of what is listed is false.
[[nodiscard]] double extraShare(const PairMeasurement& measured);

/// "misses 1.2 % of the pairs, lists 30 % too many".
[[nodiscard]] std::string pairResultText(const PairMeasurement& measured);

/// The number, or nothing.
[[nodiscard]] Value valueOf(std::optional<double> number);

/// "0.1234 %": four significant digits.
[[nodiscard]] std::string percentText(double share);

/// What ways promise, against what they did.
class PairChecks {
public:
    void take(std::span<const PairMethod> methods, const PairTrial& trial);
    [[nodiscard]] std::vector<Check> checks() const;

private:
    struct Sum {
        int ways = 0;
        std::uint64_t truePairs = 0;
        std::uint64_t missed = 0;
        std::uint64_t extra = 0;
        std::string firstWrong;

        void add(const PairMethod& method, const PairMeasurement& measured, bool isWrong);
        [[nodiscard]] std::string evidence() const;
    };

    Sum exact_;
    Sum complete_;
    int framesByBruteForce_ = 0;
    int framesThatDiffer_ = 0;
};

}  // namespace hashphase::demos
