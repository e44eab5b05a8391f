// SPDX-License-Identifier: Zlib
#include <integration/mpi/distributed_grid.hpp>

#include <broadphase/core/raise.hpp>
#include <broadphase/diagnostics.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string>

namespace hashphase {
namespace {

using Clock = std::chrono::steady_clock;

// Space is cut by so many points of all ranks together, and of each.
constexpr std::uint32_t kSamples = 1U << 18;
constexpr std::uint32_t kMostSamplesOfRank = 8192;
constexpr std::uint32_t kLeastSamplesOfRank = 64;

// Where cutting space again does not help, it is done ever more rarely.
constexpr std::uint32_t kLongestRest = 64;
constexpr double kHelpful = 0.95;

// Loads are added as whole numbers, whose sum is the same on all ranks.
constexpr double kLoadUnit = 0x1p-10;

class Timer {
public:
    explicit Timer(double& seconds) : seconds_(seconds), since_(Clock::now()) {}
    Timer(const Timer&) = delete;
    Timer& operator=(const Timer&) = delete;
    ~Timer() { seconds_ += std::chrono::duration<double>(Clock::now() - since_).count(); }

private:
    double& seconds_;
    Clock::time_point since_;
};

struct NamedSetting {
    const char* name;
    double value;
};

template <class Scalar>
std::array<NamedSetting, 11> settingsOf(const DistributedConfig& config,
                                        const Partition<Scalar>* partition, std::uint32_t ranks) {
    // Sums of numbers small enough to be exact; -1 for none.
    double cutHash = -1;
    double partitionRanks = ranks;
    if (partition != nullptr) {
        std::uint64_t hash = 0;
        for (const Cut<Scalar>& cut : partition->cuts()) {
            hash = (hash ^ std::bit_cast<std::uint64_t>(static_cast<double>(cut.at)) ^ cut.axis) *
                   0x9e3779b97f4a7c15U;
            hash ^= hash >> 32;
        }
        cutHash = static_cast<double>(hash >> 16);
        partitionRanks = partition->rankCount();
    }
    return {
        {{"the size of Scalar in bytes", sizeof(Scalar)},
         {"GridConfig::cellSize", config.rank.grid.cellSize},
         {"GridConfig::levelRatio", config.rank.grid.levelRatio},
         {"GridConfig::updatesBeforeRest", static_cast<double>(config.rank.grid.updatesBeforeRest)},
         {"GridConfig::slack", config.rank.grid.slack.value_or(-1)},
         {"RankGridConfig::payloadBytes", static_cast<double>(config.rank.payloadBytes)},
         {"DistributedConfig::rebalanceAbove", config.rebalanceAbove},
         {"DistributedConfig::patience", config.patience},
         {"the number of ranks of the partition", partitionRanks},
         {"the partition (a number made of its cuts)", cutHash},
         {"the version of the messages", 1}}};
}

std::string asText(double value) {
    std::string text = std::to_string(value);
    text.erase(text.find_last_not_of('0') + 1);
    return text.back() == '.' ? text.substr(0, text.size() - 1) : text;
}

}  // namespace

template <class Scalar>
DistributedGrid<Scalar>::DistributedGrid(MPI_Comm communicator, const DistributedConfig& config)
    : DistributedGrid(communicator, nullptr, config) {}

template <class Scalar>
DistributedGrid<Scalar>::DistributedGrid(MPI_Comm communicator, const Partition<Scalar>& partition,
                                         const DistributedConfig& config)
    : DistributedGrid(communicator, &partition, config) {}

template <class Scalar>
DistributedGrid<Scalar>::DistributedGrid(MPI_Comm communicator, const Partition<Scalar>* partition,
                                         const DistributedConfig& config)
    : config_(config),
      ranks_(communicator, config.patience),
      exchange_(ranks_),
      exceptionsAtFirst_(std::uncaught_exceptions()) {
    agree(config, partition);
    if (!(config.rebalanceAbove >= 1) || !(config.patience >= 0)) {
        detail::raiseInvalidArgument(
            "rebalanceAbove must be 1 or more, and patience 0 s or more; they are " +
            asText(config.rebalanceAbove) + " and " + asText(config.patience) + ".");
    }
    if (partition != nullptr) {
        here_.emplace(ranks_.rank(), *partition, config.rank);
        return;
    }
    // At first all lies below all cuts.
    const std::vector<Cut<Scalar>> cuts(ranks_.count() - 1,
                                        {std::numeric_limits<Scalar>::infinity(), 0});
    here_.emplace(ranks_.rank(), Partition<Scalar>(cuts), config.rank);
    mustRebalance_ = ranks_.count() > 1;
}

template <class Scalar>
DistributedGrid<Scalar>::~DistributedGrid() {
    if (std::uncaught_exceptions() > exceptionsAtFirst_) {
        ranks_.tellFailure("It was left by an exception.");
    }
    if (!ranks_.failure().empty()) {
        return;
    }
    try {  // nothing may be under way when the communicator goes
        waitForLoads();
    } catch (const std::exception&) {
        return;  // then it stays
    }
}

// Throws where a setting is not the same on all ranks: a bad one is bad on all of them, then.
template <class Scalar>
void DistributedGrid<Scalar>::agree(const DistributedConfig& config,
                                    const Partition<Scalar>* partition) {
    const auto settings = settingsOf<Scalar>(config, partition, ranks_.count());
    std::array<double, 2 * std::tuple_size_v<decltype(settings)>> least;
    for (std::size_t i = 0; i < settings.size(); ++i) {
        const double value = std::isnan(settings[i].value) ? std::numeric_limits<double>::lowest()
                                                           : settings[i].value;
        least[2 * i] = value;
        least[2 * i + 1] = -value;
    }
    MPI_Request request = MPI_REQUEST_NULL;
    ranks_.check(MPI_Iallreduce(MPI_IN_PLACE, least.data(), static_cast<int>(least.size()),
                                MPI_DOUBLE, MPI_MIN, ranks_.communicator(), &request),
                 "MPI_Iallreduce");
    ranks_.wait(request, "for all ranks to say their configuration");
    for (std::size_t i = 0; i < settings.size(); ++i) {
        if (least[2 * i] != -least[2 * i + 1]) {
            throw RankError(std::string("The ranks disagree on ") + settings[i].name + ": from " +
                            asText(least[2 * i]) + " to " + asText(-least[2 * i + 1]) +
                            "; here it is " + asText(settings[i].value) + ".");
        }
    }
    if (partition != nullptr && partition->rankCount() != ranks_.count()) {
        throw RankError("The partition is of " + std::to_string(partition->rankCount()) +
                        " ranks; there are " + std::to_string(ranks_.count()) + ".");
    }
}

// --- Failure -------------------------------------------------------------------------------------

template <class Scalar>
void DistributedGrid<Scalar>::checkUse() const {
    if (!ranks_.failure().empty()) {
        throw RankError(ranks_.failure());
    }
}

// Does the work; tells the other ranks where it throws.
template <class Scalar>
template <class Work>
auto DistributedGrid<Scalar>::tellingFailure(const Work& work) {
    checkUse();
    try {
        return work();
    } catch (const std::exception& error) {
        if (ranks_.failure().empty()) {
            ranks_.fail(error.what());
        }
        throw;
    }
}

// --- Frame ---------------------------------------------------------------------------------------

template <class Scalar>
RankChanges DistributedGrid<Scalar>::update(ParallelFor parallelFor) {
    begin();
    return end(parallelFor);
}

template <class Scalar>
void DistributedGrid<Scalar>::begin() {
    tellingFailure([&] {
        cost_ = {};
        {
            const Timer timer(cost_.rebalanceSeconds);
            if (isTimeToRebalance()) {
                rebalance();
                cost_.wasRebalanced = true;
            }
        }
        const Timer timer(cost_.packSeconds);
        exchange_.start(here_->pack());
    });
}

template <class Scalar>
RankChanges DistributedGrid<Scalar>::end(ParallelFor parallelFor) {
    return tellingFailure([&] {
        {
            const Timer timer(cost_.waitSeconds);
            exchange_.finish("for the messages of this frame");
        }
        const Timer timer(cost_.pairSeconds);
        const RankChanges changes = here_->finish(exchange_.received(), parallelFor);
        cost_.rank = here_->lastCost();
        startLoads();
        return changes;
    });
}

template <class Scalar>
void DistributedGrid<Scalar>::setLoad(double load) {
    HASHPHASE_ASSERT(load >= 0, "A load is not negative.");
    if (load >= 0) {
        givenLoad_ = load;
    }
}

// --- Balance -------------------------------------------------------------------------------------

template <class Scalar>
void DistributedGrid<Scalar>::startLoads() {
    load_ = static_cast<std::uint64_t>(
        std::min(givenLoad_.value_or(cost_.rank.load) / kLoadUnit, 0x1p46));
    const auto start = [&](std::uint64_t& result, MPI_Op operation, MPI_Request& request) {
        ranks_.check(MPI_Iallreduce(&load_, &result, 1, MPI_UINT64_T, operation,
                                    ranks_.communicator(), &request),
                     "MPI_Iallreduce");
    };
    start(loadSum_, MPI_SUM, loadRequests_[0]);
    start(loadMost_, MPI_MAX, loadRequests_[1]);
}

template <class Scalar>
void DistributedGrid<Scalar>::waitForLoads() {
    for (MPI_Request& request : loadRequests_) {
        ranks_.wait(request, "for the load of all ranks");
    }
}

// The same on all ranks: it follows from what they know together.
template <class Scalar>
bool DistributedGrid<Scalar>::isTimeToRebalance() {
    waitForLoads();
    if (loadSum_ > 0) {
        cost_.imbalance =
            static_cast<double>(loadMost_) * ranks_.count() / static_cast<double>(loadSum_);
    }
    if (ranks_.count() == 1 || std::isinf(config_.rebalanceAbove)) {
        return false;
    }
    if (std::exchange(mustRebalance_, false)) {
        return true;
    }
    // The frame that begins with a cut has the work of moving objects, too: the next one tells whether that has
    // helped. Where it has not, the next cut waits, ever longer.
    ++framesSinceCut_;
    if (framesSinceCut_ == 2) {
        const bool hasHelped = cost_.imbalance < kHelpful * imbalanceBeforeCut_;
        restAfterCut_ = hasHelped ? 0 : std::min(2 * restAfterCut_ + 1, kLongestRest);
    }
    if (cost_.imbalance <= config_.rebalanceAbove || framesSinceCut_ < 2 + restAfterCut_) {
        return false;
    }
    framesSinceCut_ = 0;
    imbalanceBeforeCut_ = cost_.imbalance;
    return true;
}

template <class Scalar>
void DistributedGrid<Scalar>::rebalance() {
    using Point = std::array<double, 4>;
    const std::uint32_t perRank =
        std::clamp(kSamples / ranks_.count(), kLeastSamplesOfRank, kMostSamplesOfRank);
    // As many of each rank, so that nobody has to ask how many; the rest weigh nothing.
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    std::vector<Point> mine(perRank, {kNan, kNan, kNan, 0});
    const double load = here_->frame() == 0 ? static_cast<double>(here_->size())
                                            : static_cast<double>(load_) * kLoadUnit;
    const std::size_t enough = here_->size() / 2 + kLeastSamplesOfRank;
    const auto samples = here_->sampleLoad(std::min<std::size_t>(perRank, enough), load);
    std::transform(
        samples.begin(), samples.end(), mine.begin(), [](const WeightedPoint<Scalar>& sample) {
            return Point{static_cast<double>(sample.at[0]), static_cast<double>(sample.at[1]),
                         static_cast<double>(sample.at[2]), sample.weight};
        });
    const bool isRoot = ranks_.rank() == 0;
    std::vector<Point> all(isRoot ? std::size_t{perRank} * ranks_.count() : 0);
    MPI_Request request = MPI_REQUEST_NULL;
    ranks_.check(
        MPI_Igather(mine.data(), static_cast<int>(4 * perRank), MPI_DOUBLE, all.data(),
                    static_cast<int>(4 * perRank), MPI_DOUBLE, 0, ranks_.communicator(), &request),
        "MPI_Igather");
    ranks_.wait(request, "for samples of the load of all ranks");
    // One rank cuts for all: so the cuts are the same, whatever compiled it.
    std::vector<std::array<double, 2>> cuts(ranks_.count() - 1);
    if (isRoot) {
        std::vector<WeightedPoint<Scalar>> points;
        points.reserve(all.size());
        for (const Point& point : all) {
            points.push_back(
                {Vector3<double>(point[0], point[1], point[2]).cast<Scalar>(), point[3]});
        }
        const bool isFirst = here_->frame() == 0;
        const auto partition = Partition<Scalar>::balanced(ranks_.count(), points,
                                                           isFirst ? nullptr : &here_->partition());
        std::transform(
            partition.cuts().begin(), partition.cuts().end(), cuts.begin(),
            [](const Cut<Scalar>& cut) {
                return std::array{static_cast<double>(cut.at), static_cast<double>(cut.axis)};
            });
    }
    ranks_.check(MPI_Ibcast(cuts.data(), static_cast<int>(2 * cuts.size()), MPI_DOUBLE, 0,
                            ranks_.communicator(), &request),
                 "MPI_Ibcast");
    ranks_.wait(request, "for the new parts of space");
    std::vector<Cut<Scalar>> typed;
    for (const auto& cut : cuts) {
        typed.push_back({static_cast<Scalar>(cut[0]), static_cast<std::uint32_t>(cut[1])});
    }
    here_->setPartition(Partition<Scalar>(typed));
}

// --- The whole -----------------------------------------------------------------------------------

template <class Scalar>
Answers<Scalar> DistributedGrid<Scalar>::ask(std::span<const Question<Scalar>> questions) {
    return tellingFailure([&] {
        exchange_.start(questions_.pack(*here_, questions));
        exchange_.finish("for the questions of all ranks");
        exchange_.start(questions_.answer(*here_, exchange_.received()));
        exchange_.finish("for the answers of all ranks");
        return questions_.finish(exchange_.received());
    });
}

template <class Scalar>
PairSum DistributedGrid<Scalar>::pairSum() {
    return tellingFailure([&] {
        const PairSum mine = here_->pairSum();
        std::array<std::uint64_t, 2> numbers{mine.count, mine.hash};
        MPI_Request request = MPI_REQUEST_NULL;
        ranks_.check(MPI_Iallreduce(MPI_IN_PLACE, numbers.data(), 2, MPI_UINT64_T, MPI_SUM,
                                    ranks_.communicator(), &request),
                     "MPI_Iallreduce");
        ranks_.wait(request, "for the sums of all ranks");
        return PairSum{numbers[0], numbers[1]};
    });
}

template class HASHPHASE_INSTANCE_EXPORT DistributedGrid<float>;
template class HASHPHASE_INSTANCE_EXPORT DistributedGrid<double>;

}  // namespace hashphase
