// SPDX-License-Identifier: Zlib
#pragma once

// A grid over the processes of an MPI program: exact pairs and queries over all of them, each pair once.
//
// Objects   See rank_grid.hpp for objects, ghosts, payloads, pairs, and when changes are visible. changes.departed
//           and .arrived list objects that moved between ranks: send their data that is not in the payload.
// Balance   If the slowest rank has too much of the work, update() cuts space again.
// Together  All ranks call the constructor, update() or begin() and end(), ask(), sendHome(), pairSum() and the
//           destructor in the same order. All other calls are local.
// Failure   These calls throw RankError on all ranks, which names the rank and the reason: an exception left the
//           grid's scope, configurations differ, no answer came within DistributedConfig::patience, or a message is
//           invalid. The grid is then unusable: they throw again. Call MPI_Abort(). If a process dies, the MPI
//           library ends the program.
// Misuse    RankError on all ranks: calls in another order, and ask() or pairSum() after a change. Destroy the grid
//           before MPI_Finalize(), and not between begin() and end().
// Threads   Call from the thread that may call MPI (MPI_THREAD_FUNNELED). Queries of here().grid() may run on
//           several.
// Machines  All of one kind: numbers travel as they are in memory.

#include <integration/distributed/contributions.hpp>
#include <integration/distributed/questions.hpp>
#include <integration/distributed/rank_grid.hpp>
#include <integration/mpi/detail/ranks.hpp>
#include <integration/mpi/detail/sparse_exchange.hpp>
#include <integration/mpi/export.hpp>

#include <mpi.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace hashphase {

/// Settings, equal on all ranks.
struct DistributedConfig {
    RankGridConfig rankGrid;

    /// Space is cut again if the most loaded rank has more than this times the mean load, and more than the error of
    /// a cut: 1.04 up to 128 ranks, 1.13 for 1,024, 1.5 for 16,384. Valid: 1 or more; with infinity only in the first
    /// frame, and by balanceNow().
    double rebalanceAbove = 1.1;

    /// How long to wait for another rank [s]; 0: for ever. Choose more than any rank takes between two updates.
    double patience = 600;
};

/// Cost of the last frame on this rank, and its balance. Questions do not count.
struct DistributedCost {
    RankCost rankGrid;
    /// Largest load of all ranks, as a multiple of their mean, in the frame before this one.
    double imbalance = 1;
    bool wasRebalanced = false;   ///< space was cut again at the beginning of this frame
    double rebalanceSeconds = 0;  ///< measuring the load, and cutting space
    double packSeconds = 0;       ///< finding the changes for other ranks
    double waitSeconds = 0;       ///< for messages of other ranks, in end()
    double pairSeconds = 0;       ///< taking their changes, and finding pairs
};

/// This rank's objects, ghosts and pairs, and its messages to other ranks.
template <class Scalar>
class HASHPHASE_MPI_TEMPLATE_EXPORT DistributedGrid {
public:
    using Box = Aabb<Scalar>;

    /// Duplicates `communicator`. The first frame cuts space by the objects that exist then. Throws RankError on all
    /// ranks if configurations differ, and std::invalid_argument if they are bad.
    explicit DistributedGrid(MPI_Comm communicator, const DistributedConfig& config = {});
    /// Begins with a partition, equal on all ranks, such as from an earlier run. Objects that are added on their own
    /// rank do not have to move. Throws RankError also if partitions differ, or have another number of ranks.
    DistributedGrid(MPI_Comm communicator, const Partition<Scalar>& partition,
                    const DistributedConfig& config = {});
    DistributedGrid(const DistributedGrid&) = delete;
    DistributedGrid& operator=(const DistributedGrid&) = delete;
    /// If an exception is under way, tells the other ranks instead of waiting for them.
    ~DistributedGrid();

    // --- Objects: see RankGrid -------------------------------------------------------------------

    ProxyId add(GlobalId object, const Box& box, const ProxyGroups& groups = {}) {
        return here_->add(object, box, groups);
    }
    void move(ProxyId id, const Box& box) { here_->move(id, box); }
    void remove(ProxyId id) { here_->remove(id); }
    [[nodiscard]] std::span<std::byte> payload(ProxyId id) { return here_->payload(id); }
    /// This rank's part: objects, ghosts, payloads, ids and partition.
    [[nodiscard]] const RankGrid<Scalar>& here() const noexcept { return *here_; }

    // --- Frame -----------------------------------------------------------------------------------

    /// begin() and end().
    RankChanges update(ParallelFor parallelFor = serialFor);

    /// Ends the changes of this frame, and sends them. Until end(), do other work: query here().grid(), and look up
    /// ids and payloads in here(). Asserted: no changes, no payload(), and no here().forEachPair(), collect() or
    /// pairSum().
    void begin();

    /// Takes the changes of other ranks. Returns this rank's changes, valid until the next begin(). Cost:
    /// RankGrid::finish(), a message to each rank concerned, and a barrier.
    RankChanges end(ParallelFor parallelFor = serialFor);

    /// Sets this rank's load from the next frame on, in any unit, such as the milliseconds of its whole step; by
    /// default, or with std::nullopt, RankCost::load. On all ranks or on none, because loads are compared. Asserted:
    /// not negative.
    void setLoad(std::optional<double> load);

    /// Cuts space again at the beginning of the frame after the next one, whatever the balance. One rank is enough.
    void balanceNow() noexcept { wantsCut_ = true; }

    // --- The whole -------------------------------------------------------------------------------

    /// Sends bytes about ghosts, such as forces, to the ranks of their objects, after update() and before objects
    /// move. Returns other ranks' contributions to objects of this rank, sorted by rank, valid until the next
    /// sendHome(), ask() or begin(). Cost: a message to each rank concerned, and a barrier.
    std::span<const Contribution> sendHome(std::span<const Contribution> forGhosts);

    /// Asks all ranks concerned, after update() and before the next change. Returns the answers to this rank's
    /// questions, valid until the next call. Cost: two exchanges of messages, each with a barrier.
    Answers<Scalar> ask(std::span<const Question<Scalar>> questions);

    /// Returns the sum of the pairs of all ranks, the same on all of them, after update() and before the next change.
    /// Cost: Pairs::collect(), and a sum over all ranks.
    PairSum pairSum();

    [[nodiscard]] const DistributedCost& lastCost() const noexcept { return cost_; }

    /// The grid's own communicator. Send nothing by it: the grid uses its tags, and non-blocking collectives between
    /// calls.
    [[nodiscard]] MPI_Comm communicator() const noexcept { return ranks_.communicator(); }

private:
    DistributedGrid(MPI_Comm communicator, const Partition<Scalar>* partition,
                    const DistributedConfig& config);
    void agree(const DistributedConfig& config, const Partition<Scalar>* partition);
    void rebalance();
    [[nodiscard]] bool isTimeToRebalance();
    void startLoads();
    void waitForLoads();
    void checkUse(bool isBegun);
    void checkUpToDate();
    [[nodiscard]] double errorOfCuts() const noexcept;
    template <class Work>
    auto together(bool isBegun, const Work& work);

    DistributedConfig config_;
    detail::Ranks ranks_;
    detail::SparseExchange exchange_;
    std::optional<RankGrid<Scalar>> here_;
    RankQuestions<Scalar> questions_;
    Contributions contributions_;
    DistributedCost cost_;
    int exceptionsAtFirst_;

    // Loads at the end of a frame, which all ranks know by the beginning of the next one.
    struct Loads {
        std::array<std::uint64_t, 2> mine{};  // the load, and whether balanceNow() was called
        std::array<std::uint64_t, 2> most{};
        std::uint64_t sum = 0;
    };
    std::optional<double> givenLoad_;
    std::shared_ptr<Loads> loads_ = std::make_shared<Loads>();
    std::array<MPI_Request, 2> loadRequests_{MPI_REQUEST_NULL, MPI_REQUEST_NULL};
    bool isFirstToCut_ = false;  // in the first frame; the same on all ranks
    bool wantsCut_ = false;
    bool isBegun_ = false;
    std::uint32_t framesSinceCut_ = 2;
    std::uint32_t restAfterCut_ = 0;  // frames that the next cut waits longer
    double imbalanceBeforeCut_ = 1;
};

extern template class DistributedGrid<float>;
extern template class DistributedGrid<double>;

}  // namespace hashphase
