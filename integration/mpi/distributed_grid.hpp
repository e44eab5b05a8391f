// SPDX-License-Identifier: Zlib
#pragma once

// A grid over all processes (ranks) of an MPI program. The grid reports exact pairs, each once, and answers queries.
//
// Objects   See rank_grid.hpp for objects, ghosts, payloads, pairs, and when changes are visible. RankChanges lists
//           objects that have moved between ranks. Your program must send data of these objects that is not in the
//           payload.
// Balance   Each rank has a region of space. If one rank has too much work, update() cuts space into new regions.
// Together  These calls are collective: constructor, update() (or begin() and end()), ask(), sendHome(), pairSum(),
//           destructor. All ranks must make these calls in the same order. All other calls are local.
// Failure   If one rank fails, collective calls on all ranks throw RankError, which names the rank and the reason: an
//           exception in a collective call, an exception that destroyed the grid, no answer within
//           DistributedConfig::patience, or an invalid message. If configurations differ, RankError names the
//           setting instead of a rank. After a RankError, the grid is unusable: call MPI_Abort(). Collective calls
//           throw again. If a process dies, the MPI library ends the program.
// Misuse    If ranks make collective calls in different orders, or call ask() or pairSum() between a change of their
//           objects and the next update(), all ranks throw RankError. Destroy the grid before MPI_Finalize(), and not between begin() and end().
// Threads   While no call changes the grid, any thread may query here().grid(). Make all other calls from the thread
//           that may call MPI (MPI_THREAD_FUNNELED).
// Machines  All machines must be of one kind: messages contain numbers in machine format.

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

/// Settings, which must be equal on all ranks.
struct DistributedConfig {
    RankGridConfig rankGrid;

    /// update() cuts space again if the largest load of a rank exceeds this factor times the mean load. Because cuts
    /// have errors, the factor used is at least 1.04 for 128 or fewer ranks, 1.13 for 1,024 ranks, and 1.5 for 16,384
    /// ranks. Valid: 1 or more. If infinite, space is cut only by balanceNow() and, if you pass no partition, by the
    /// first update().
    double rebalanceAbove = 1.1;

    /// Longest time to wait for another rank [s]. If 0, calls wait without limit. Choose more time than any rank
    /// needs between two updates.
    double patience = 600;
};

/// Cost of the last frame on this rank, and the balance of all ranks. Includes only update(), or begin() and end().
struct DistributedCost {
    RankCost rankGrid;
    /// Largest load of a rank, divided by the mean load of all ranks, in the frame before the last frame.
    double imbalance = 1;
    bool wasRebalanced = false;   ///< space was cut again at the beginning of the last frame
    double rebalanceSeconds = 0;  ///< measuring the load, and cutting space
    double packSeconds = 0;       ///< finding the changes for other ranks
    double waitSeconds = 0;       ///< waiting for other ranks' messages, in end()
    double pairSeconds = 0;       ///< applying other ranks' changes, and finding pairs
};

namespace detail {

// Not within the class, which is exported: templates of it stay hidden.
struct FrameLoads;

}  // namespace detail

/// This rank's objects, ghosts and pairs, and its messages to other ranks.
template <class Scalar>
class HASHPHASE_MPI_TEMPLATE_EXPORT DistributedGrid {
public:
    using Box = Aabb<Scalar>;

    /// Duplicates `communicator`. The first update() cuts space so that the objects are balanced. Throws RankError on
    /// all ranks if configurations differ, and std::invalid_argument if the configuration is invalid.
    explicit DistributedGrid(MPI_Comm communicator, const DistributedConfig& config = {});
    /// Begins with a partition, such as from an earlier run. The first update() keeps this partition. All ranks must
    /// pass equal partitions. Objects that you add on their home rank need no transfer. Also throws RankError if
    /// partitions differ, or have more or fewer ranks than the communicator.
    DistributedGrid(MPI_Comm communicator, const Partition<Scalar>& partition,
                    const DistributedConfig& config = {});
    DistributedGrid(const DistributedGrid&) = delete;
    DistributedGrid& operator=(const DistributedGrid&) = delete;
    /// During stack unwinding, informs the other ranks instead of waiting for them.
    ~DistributedGrid();

    // --- Objects: see RankGrid -------------------------------------------------------------------

    ProxyId add(GlobalId object, const Box& box, const ProxyGroups& groups = {}) {
        return here_->add(object, box, groups);
    }
    void move(ProxyId id, const Box& box) { here_->move(id, box); }
    void remove(ProxyId id) { here_->remove(id); }
    [[nodiscard]] std::span<std::byte> payload(ProxyId id) { return here_->payload(id); }
    /// Returns this rank's part: objects, ghosts, payloads, ids and partition.
    [[nodiscard]] const RankGrid<Scalar>& here() const noexcept { return *here_; }

    // --- Frame -----------------------------------------------------------------------------------

    /// Calls begin(), then end().
    RankChanges update(ParallelFor parallelFor = serialFor);

    /// Ends the changes of this frame, and sends them. Until end(), you may do other work, query here().grid(), and
    /// read ids and payloads in here(). Until end(), these calls fail an assertion: add(), move(), remove(),
    /// payload(), here().forEachPair(), here().collect(), here().pairSum().
    void begin();

    /// Receives the changes of other ranks. Returns the changes on this rank, valid until the next begin(). Cost: as
    /// RankGrid::finish(), plus a message to each receiving rank, and a barrier.
    RankChanges end(ParallelFor parallelFor = serialFor);

    /// Sets this rank's load, from the next end() on, in any unit, such as the milliseconds of the rank's whole step.
    /// By default, or with std::nullopt, the load is RankCost::load. Set the load on all ranks or on none, because
    /// loads are compared. Asserted: the load is not negative.
    void setLoad(std::optional<double> load);

    /// Cuts space again at the beginning of the frame after the next, even if work is balanced. A call on one rank is
    /// enough.
    void balanceNow() noexcept { wantsCut_ = true; }

    // --- The whole -------------------------------------------------------------------------------

    /// Sends bytes about ghosts, such as forces, to the homes of the objects. Call it after update(), before the next
    /// change. Returns other ranks' contributions to objects of this rank, sorted by sender, valid until the next
    /// sendHome(), ask() or begin(). Cost: a message to each receiving rank, and a barrier.
    std::span<const Contribution> sendHome(std::span<const Contribution> forGhosts);

    /// Sends each question to all ranks that may have answers. Call it after update(), before the next change.
    /// Returns the answers to this rank's questions, valid until the next ask(). Cost: two exchanges of messages,
    /// each with a barrier.
    Answers<Scalar> ask(std::span<const Question<Scalar>> questions);

    /// Returns the checksum of the pairs of all ranks. Each rank gets the same checksum. Call it after update(),
    /// before the next change. Cost: as Pairs::collect(), plus one MPI reduction.
    PairSum pairSum();

    [[nodiscard]] const DistributedCost& lastCost() const noexcept { return cost_; }

    /// The grid's own communicator. Send no messages with this communicator: the grid uses its tags, and runs
    /// non-blocking collectives between calls.
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

    std::optional<double> givenLoad_;
    std::shared_ptr<detail::FrameLoads> loads_;
    std::array<MPI_Request, 2> loadRequests_{MPI_REQUEST_NULL, MPI_REQUEST_NULL};
    bool isFirstToCut_ = false;  // the first frame must cut; equal on all ranks
    bool wantsCut_ = false;
    bool isBegun_ = false;
    std::uint32_t framesSinceCut_ = 2;
    std::uint32_t restAfterCut_ = 0;  // number of extra frames before the next cut
    double imbalanceBeforeCut_ = 1;
};

extern template class DistributedGrid<float>;
extern template class DistributedGrid<double>;

}  // namespace hashphase
