// SPDX-License-Identifier: Zlib
#include <integration/mpi/distributed_grid.hpp>

#include <broadphase/core/raise.hpp>
#include <broadphase/diagnostics.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <exception>
#include <limits>
#include <new>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace hashphase {

/// Loads at the end of a frame: of this rank, and the maximum and sum of all ranks, known from the next frame on.
struct detail::FrameLoads {
    std::array<std::uint64_t, 2> mine{};  // the load, and whether balanceNow() was called
    std::array<std::uint64_t, 2> most{};
    std::uint64_t sum = 0;
};

namespace {

using Clock = std::chrono::steady_clock;

// Space is cut by so many points of all ranks together, and of each.
constexpr std::uint32_t kSamples = 1U << 20;
constexpr std::uint32_t kMostSamplesOfRank = 8192;
constexpr std::uint32_t kLeastSamplesOfRank = 64;

constexpr std::uint32_t samplesOfRank(std::uint32_t ranks) {
    return std::clamp(kSamples / ranks, kLeastSamplesOfRank, kMostSamplesOfRank);
}

// Where cutting space again does not help, it is done ever more rarely.
constexpr std::uint32_t kLongestRest = 64;
constexpr double kHelpful = 0.95;

// Loads are added as whole numbers, whose sum is the same on all ranks: a millionth of a program's unit, or some
// thousand tests of boxes.
constexpr double kGivenLoadUnit = 0x1p-20;
constexpr double kCountedLoadUnit = 0x1p10;

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

/// What MPI reads and writes while space is cut: points [m] with their weights, and the cuts.
struct CutBuffers {
    using Point = std::array<double, 4>;

    std::vector<Point> mine;
    std::vector<Point> all;
    std::vector<std::array<double, 2>> cuts;
};

struct NamedSetting {
    const char* name;
    double value;
};

template <class Scalar>
std::array<NamedSetting, 12> settingsOf(const DistributedConfig& config,
                                        const Partition<Scalar>* partition, std::uint32_t ranks) {
    // -1 for none.
    double cutHash = -1;
    double partitionRanks = ranks;
    if (partition != nullptr) {
        std::uint64_t hash = 0;
        for (const Cut<Scalar>& cut : partition->cuts()) {
            hash = detail::mixedBits(
                hash ^ std::bit_cast<std::uint64_t>(static_cast<double>(cut.at)) ^ cut.axis);
        }
        cutHash = static_cast<double>(hash >> 16);
        partitionRanks = partition->rankCount();
    }
    return {{{"the size of Scalar in bytes", sizeof(Scalar)},
             {"GridConfig::cellSize", config.rankGrid.grid.cellSize},
             {"GridConfig::levelRatio", config.rankGrid.grid.levelRatio},
             {"GridConfig::updatesBeforeRest",
              static_cast<double>(config.rankGrid.grid.updatesBeforeRest)},
             {"GridConfig::slack", config.rankGrid.grid.slack.value_or(-1)},
             {"GridConfig::slack (whether it is set)", config.rankGrid.grid.slack ? 1.0 : 0.0},
             {"RankGridConfig::payloadBytes", static_cast<double>(config.rankGrid.payloadBytes)},
             {"DistributedConfig::rebalanceAbove", config.rebalanceAbove},
             {"DistributedConfig::patience", config.patience},
             {"the number of ranks of the partition", partitionRanks},
             {"the partition (a hash of its cuts)", cutHash},
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
      exceptionsAtFirst_(std::uncaught_exceptions()),
      loads_(std::make_shared<detail::FrameLoads>()) {
    agree(config, partition);
    if (!(config.rebalanceAbove >= 1) || !(config.patience >= 0)) {
        detail::raiseInvalidArgument(
            "DistributedConfig: rebalanceAbove must be 1 or more, and patience 0 s or more, but "
            "they are " +
            asText(config.rebalanceAbove) + " and " + asText(config.patience) + ".");
    }
    try {
        // Without a partition all lies below all cuts, at first.
        const std::vector<Cut<Scalar>> cuts(ranks_.count() - 1,
                                            {std::numeric_limits<Scalar>::infinity(), 0});
        here_.emplace(ranks_.rank(), partition != nullptr ? *partition : Partition<Scalar>(cuts),
                      config.rankGrid);
    } catch (const std::bad_alloc&) {  // what else is thrown, all ranks throw
        ranks_.fail(
            "Its part of the grid does not fit into memory. Use more ranks, or free memory.");
    }
    isFirstToCut_ = partition == nullptr && ranks_.count() > 1;
}

template <class Scalar>
DistributedGrid<Scalar>::~DistributedGrid() {
    if (std::uncaught_exceptions() > exceptionsAtFirst_) {
        ranks_.tellFailure(
            "An exception of the program destroyed its grid. See the output of that rank.");
    } else if (isBegun_) {
        ranks_.tellFailure("Its grid was destroyed between begin() and end(). Call end() first.");
    }
    if (!detail::Ranks::isMpiReady()) {
        return;
    }
    try {  // nothing may be under way when the communicator goes
        checkUse(isBegun_);
        waitForLoads();
    } catch (const std::exception&) {
        detail::Ranks::abandon(loads_);  // the communicator stays
    }
}

// Throws where a setting is not the same on all ranks: a bad one is bad on all of them, then.
template <class Scalar>
void DistributedGrid<Scalar>::agree(const DistributedConfig& config,
                                    const Partition<Scalar>* partition) {
    const auto settings = settingsOf<Scalar>(config, partition, ranks_.count());
    using Least = std::array<double, 2 * std::tuple_size_v<decltype(settings)>>;
    const auto buffer = std::make_shared<Least>();
    Least& least = *buffer;
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
    ranks_.wait(request, buffer, "for the configurations of all ranks");
    for (std::size_t i = 0; i < settings.size(); ++i) {
        if (least[2 * i] != -least[2 * i + 1]) {
            throw RankError(std::string("The ranks disagree on ") + settings[i].name +
                            ": it is from " + asText(least[2 * i]) + " to " +
                            asText(-least[2 * i + 1]) + ", and here " + asText(settings[i].value) +
                            ". Set the same on all ranks.");
        }
    }
    if (partition != nullptr && partition->rankCount() != ranks_.count()) {
        throw RankError("The partition has " + std::to_string(partition->rankCount()) +
                        " ranks, but the communicator has " + std::to_string(ranks_.count()) +
                        ". Make a partition for that number.");
    }
}

// --- Failure -------------------------------------------------------------------------------------

template <class Scalar>
void DistributedGrid<Scalar>::checkUse(bool isBegun) {
    if (!ranks_.failure().empty()) {
        throw RankError(ranks_.failure());
    }
    if (isBegun != isBegun_) {
        ranks_.fail(isBegun ? "It called end() without begin(). Call begin() first."
                            : "It called begin(), ask(), sendHome() or pairSum() between begin() "
                              "and end(). Call end() first.");
    }
}

template <class Scalar>
void DistributedGrid<Scalar>::checkUpToDate() {
    if (!here_->isUpToDate()) {
        ranks_.fail("It called ask() or pairSum() after a change. Call update() first.");
    }
}

// Does what all ranks do together; tells the others where it throws.
template <class Scalar>
template <class Work>
auto DistributedGrid<Scalar>::together(bool isBegun, const Work& work) {
    checkUse(isBegun);
    try {
        return work();
    } catch (const std::exception& error) {
        if (ranks_.failure().empty()) {
            ranks_.fail(error.what());
        }
        throw;
    } catch (...) {
        ranks_.tellFailure("It threw an exception that is no std::exception.");
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
    together(false, [&] {
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
        isBegun_ = true;
    });
}

template <class Scalar>
RankChanges DistributedGrid<Scalar>::end(ParallelFor parallelFor) {
    return together(true, [&] {
        {
            const Timer timer(cost_.waitSeconds);
            exchange_.finish("for the messages of this frame");
        }
        const Timer timer(cost_.pairSeconds);
        const RankChanges changes = here_->finish(exchange_.received(), parallelFor);
        cost_.rankGrid = here_->lastCost();
        isBegun_ = false;
        startLoads();
        return changes;
    });
}

template <class Scalar>
void DistributedGrid<Scalar>::setLoad(std::optional<double> load) {
    HASHPHASE_ASSERT(!load || *load >= 0,
                     "DistributedGrid::setLoad(): the load is negative or NaN. Pass 0 or more.");
    if (!load || *load >= 0) {
        givenLoad_ = load;
    }
}

// --- Balance -------------------------------------------------------------------------------------

template <class Scalar>
void DistributedGrid<Scalar>::startLoads() {
    const double load =
        givenLoad_ ? *givenLoad_ / kGivenLoadUnit : cost_.rankGrid.load / kCountedLoadUnit;
    const double most = 0x1p62 / ranks_.count();
    loads_->mine = {static_cast<std::uint64_t>(std::min(load, most)),
                    std::exchange(wantsCut_, false) ? 1U : 0U};
    const auto start = [&](std::uint64_t* result, int count, MPI_Op operation,
                           MPI_Request& request) {
        ranks_.check(MPI_Iallreduce(loads_->mine.data(), result, count, MPI_UINT64_T, operation,
                                    ranks_.communicator(), &request),
                     "MPI_Iallreduce");
    };
    start(&loads_->sum, 1, MPI_SUM, loadRequests_[0]);
    start(loads_->most.data(), 2, MPI_MAX, loadRequests_[1]);
}

template <class Scalar>
void DistributedGrid<Scalar>::waitForLoads() {
    for (MPI_Request& request : loadRequests_) {
        ranks_.wait(std::exchange(request, MPI_REQUEST_NULL), loads_, "for the load of all ranks");
    }
}

// The same on all ranks: it follows from what they know together.
template <class Scalar>
bool DistributedGrid<Scalar>::isTimeToRebalance() {
    waitForLoads();
    if (loads_->sum > 0) {
        cost_.imbalance = static_cast<double>(loads_->most[0]) * ranks_.count() /
                          static_cast<double>(loads_->sum);
    }
    if (ranks_.count() == 1) {
        return false;
    }
    // The frame that begins with a cut has the work of moving objects, too: the next one tells whether that has
    // helped. Where it has not, the next cut waits, ever longer.
    ++framesSinceCut_;
    if (framesSinceCut_ == 2) {
        const bool hasHelped = cost_.imbalance < kHelpful * imbalanceBeforeCut_;
        restAfterCut_ = hasHelped ? 0 : std::min(2 * restAfterCut_ + 1, kLongestRest);
    }
    const bool isUneven = cost_.imbalance > std::max(config_.rebalanceAbove, errorOfCuts()) &&
                          framesSinceCut_ >= 2 + restAfterCut_;
    const bool isAsked = std::exchange(isFirstToCut_, false) || loads_->most[1] > 0;
    if (isUneven || isAsked) {
        framesSinceCut_ = 0;
        imbalanceBeforeCut_ = cost_.imbalance;
    }
    return isUneven || isAsked;
}

template <class Scalar>
double DistributedGrid<Scalar>::errorOfCuts() const noexcept {
    return 1 + 4 / std::sqrt(static_cast<double>(samplesOfRank(ranks_.count())));
}

template <class Scalar>
void DistributedGrid<Scalar>::rebalance() {
    const std::uint32_t perRank = samplesOfRank(ranks_.count());
    const bool isRoot = ranks_.rank() == 0;
    // As many of each rank, so that nobody has to ask how many; the rest weigh nothing.
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    const auto buffers = std::make_shared<CutBuffers>();
    buffers->mine.resize(perRank, {kNan, kNan, kNan, 0});
    buffers->all.resize(isRoot ? std::size_t{perRank} * ranks_.count() : 0);
    buffers->cuts.resize(ranks_.count() - 1);
    const double load = here_->frame() == 0 ? static_cast<double>(here_->size())
                                            : static_cast<double>(loads_->mine[0]);
    const std::size_t enough = here_->size() / 2 + kLeastSamplesOfRank;
    const auto samples = here_->sampleLoad(std::min<std::size_t>(perRank, enough), load);
    std::transform(samples.begin(), samples.end(), buffers->mine.begin(),
                   [](const WeightedPoint<Scalar>& sample) {
                       return CutBuffers::Point{static_cast<double>(sample.at[0]),
                                                static_cast<double>(sample.at[1]),
                                                static_cast<double>(sample.at[2]), sample.weight};
                   });
    MPI_Request request = MPI_REQUEST_NULL;
    ranks_.check(MPI_Igather(buffers->mine.data(), static_cast<int>(4 * perRank), MPI_DOUBLE,
                             buffers->all.data(), static_cast<int>(4 * perRank), MPI_DOUBLE, 0,
                             ranks_.communicator(), &request),
                 "MPI_Igather");
    ranks_.wait(request, buffers, "for samples of the load of all ranks");
    // One rank cuts for all: so the cuts are the same, whatever compiled it.
    if (isRoot) {
        std::vector<WeightedPoint<Scalar>> points;
        points.reserve(buffers->all.size());
        for (const CutBuffers::Point& point : buffers->all) {
            points.push_back(
                {Vector3<double>(point[0], point[1], point[2]).template cast<Scalar>(), point[3]});
        }
        const bool isFirst = here_->frame() == 0;
        const auto partition = Partition<Scalar>::balanced(ranks_.count(), points,
                                                           isFirst ? nullptr : &here_->partition());
        std::transform(
            partition.cuts().begin(), partition.cuts().end(), buffers->cuts.begin(),
            [](const Cut<Scalar>& cut) {
                return std::array{static_cast<double>(cut.at), static_cast<double>(cut.axis)};
            });
    }
    ranks_.check(MPI_Ibcast(buffers->cuts.data(), static_cast<int>(2 * buffers->cuts.size()),
                            MPI_DOUBLE, 0, ranks_.communicator(), &request),
                 "MPI_Ibcast");
    ranks_.wait(request, buffers, "for the new parts of space");
    std::vector<Cut<Scalar>> typed;
    for (const auto& cut : buffers->cuts) {
        typed.push_back({static_cast<Scalar>(cut[0]), static_cast<std::uint32_t>(cut[1])});
    }
    here_->setPartition(Partition<Scalar>(typed));
}

// --- The whole -----------------------------------------------------------------------------------

template <class Scalar>
Answers<Scalar> DistributedGrid<Scalar>::ask(std::span<const Question<Scalar>> questions) {
    return together(false, [&] {
        checkUpToDate();
        exchange_.start(questions_.pack(*here_, questions));
        exchange_.finish("for the questions of all ranks");
        exchange_.start(questions_.answer(*here_, exchange_.received()));
        exchange_.finish("for the answers of all ranks");
        return questions_.finish(exchange_.received());
    });
}

template <class Scalar>
std::span<const Contribution> DistributedGrid<Scalar>::sendHome(
    std::span<const Contribution> forGhosts) {
    return together(false, [&] {
        exchange_.start(contributions_.pack(*here_, forGhosts));
        exchange_.finish("for the contributions of all ranks");
        return contributions_.finish(*here_, exchange_.received());
    });
}

template <class Scalar>
PairSum DistributedGrid<Scalar>::pairSum() {
    return together(false, [&] {
        checkUpToDate();
        const PairSum mine = here_->pairSum();
        const auto numbers = std::make_shared<std::array<std::uint64_t, 2>>();
        *numbers = {mine.count, mine.hash};
        MPI_Request request = MPI_REQUEST_NULL;
        ranks_.check(MPI_Iallreduce(MPI_IN_PLACE, numbers->data(), 2, MPI_UINT64_T, MPI_SUM,
                                    ranks_.communicator(), &request),
                     "MPI_Iallreduce");
        ranks_.wait(request, numbers, "for the sums of all ranks");
        return PairSum{(*numbers)[0], (*numbers)[1]};
    });
}

template class HASHPHASE_INSTANCE_EXPORT DistributedGrid<float>;
template class HASHPHASE_INSTANCE_EXPORT DistributedGrid<double>;

}  // namespace hashphase
