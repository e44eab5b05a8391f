// SPDX-License-Identifier: Zlib
#pragma once

// A grid over all processes (ranks) of an MPI program. It reports exact pairs, each once, and answers queries.
//
// Objects   See rank_grid.hpp for objects, ghosts, payloads, pairs, and when changes are visible. RankChanges lists
//           objects that have moved between ranks. Your program must send their data that is not in the payload.
// Balance   If one rank has too much of the work, update() cuts space again.
// Together  These calls are collective: constructor, update() (or begin() and end()), ask(), sendHome(), pairSum(),
//           destructor. All ranks must make them in the same order. All other calls are local.
// Failure   If one rank fails, collective calls on all ranks throw RankError, which names the rank and the reason:
//           an exception destroyed the grid, no answer came within DistributedConfig::patience, or a message is
//           invalid. Different configurations also cause a RankError. After a RankError, the grid is unusable, and
//           collective calls throw again. Call MPI_Abort(). If a process dies, the MPI library ends the program.
// Misuse    Collective calls in another order, and ask() or pairSum() after a change, throw RankError on all ranks.
//           Destroy the grid before MPI_Finalize(), and not between begin() and end().
// Threads   Call all members from the thread that may call MPI (MPI_THREAD_FUNNELED). Several threads may query
//           here().grid().
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

/// Settings, equal on all ranks.
struct DistributedConfig {
    RankGridConfig rankGrid;

    /// Space is cut again if the most loaded rank has more than this factor times the mean load. The factor is never
    /// below the error of a cut: 1.04 up to 128 ranks, 1.13 for 1,024, 1.5 for 16,384. Valid: 1 or more. With
    /// infinity, only the first frame and balanceNow() cut space.
    double rebalanceAbove = 1.1;

    /// How long to wait for another rank [s]; 0 waits for ever. Choose more than any rank takes between two updates.
    double patience = 600;
};

/// Cost of the last frame on this rank, and the balance of all ranks. Questions do not count.
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

/// This rank's objects, ghosts and pairs, and its messages to other ranks.
template <class Scalar>
class HASHPHASE_MPI_TEMPLATE_EXPORT DistributedGrid {
public:
    using Box = Aabb<Scalar>;

    /// Duplicates `communicator`. The first update() cuts space by the objects present. Throws RankError on all ranks
    /// if configurations differ, and std::invalid_argument if they are invalid.
    explicit DistributedGrid(MPI_Comm communicator, const DistributedConfig& config = {});
    /// Begins with a partition, equal on all ranks, such as from an earlier run. Objects that you add on their home
    /// rank need not move. Also throws RankError if partitions differ, or have another number of ranks.
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
    /// read ids and payloads in here(). Asserted until end(): no changes, no payload(), and no here().forEachPair(),
    /// collect() or pairSum().
    void begin();

    /// Receives the changes of other ranks. Returns the changes on this rank, valid until the next begin(). Cost: as
    /// RankGrid::finish(), plus a message to each rank concerned, and a barrier.
    RankChanges end(ParallelFor parallelFor = serialFor);

    /// Sets this rank's load from the next frame on, in any unit, such as the milliseconds of its whole step. By
    /// default, or with std::nullopt, the load is RankCost::load. Set it on all ranks or on none, because loads are
    /// compared. Asserted: not negative.
    void setLoad(std::optional<double> load);

    /// Cuts space again at the beginning of the frame after the next, whatever the balance. Call it on any rank.
    void balanceNow() noexcept { wantsCut_ = true; }

    // --- The whole -------------------------------------------------------------------------------

    /// Sends bytes about ghosts, such as forces, to the homes of their objects. Call it after update(), before
    /// objects move. Returns other ranks' contributions to objects of this rank, sorted by sending rank, valid until
    /// the next sendHome(), ask() or begin(). Cost: a message to each rank concerned, and a barrier.
    std::span<const Contribution> sendHome(std::span<const Contribution> forGhosts);

    /// Asks all ranks that may have answers. Call it after update(), before the next change. Returns the answers to
    /// this rank's questions, valid until the next ask(). Cost: two exchanges of messages, each with a barrier.
    Answers<Scalar> ask(std::span<const Question<Scalar>> questions);

    /// Returns the sum of the pairs of all ranks, equal on all ranks. Call it after update(), before the next change.
    /// Cost: as Pairs::collect(), plus a sum over all ranks.
    PairSum pairSum();

    [[nodiscard]] const DistributedCost& lastCost() const noexcept { return cost_; }

    /// The grid's own communicator. Send no messages with it: the grid uses its tags, and runs non-blocking
    /// collectives between calls.
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

    // Loads at the end of a frame. All ranks know them at the beginning of the next frame.
    struct Loads {
        std::array<std::uint64_t, 2> mine{};  // the load, and whether balanceNow() was called
        std::array<std::uint64_t, 2> most{};
        std::uint64_t sum = 0;
    };
    std::optional<double> givenLoad_;
    std::shared_ptr<Loads> loads_ = std::make_shared<Loads>();
    std::array<MPI_Request, 2> loadRequests_{MPI_REQUEST_NULL, MPI_REQUEST_NULL};
    bool isFirstToCut_ = false;  // in the first frame; equal on all ranks
    bool wantsCut_ = false;
    bool isBegun_ = false;
    std::uint32_t framesSinceCut_ = 2;
    std::uint32_t restAfterCut_ = 0;  // extra frames before the next cut
    double imbalanceBeforeCut_ = 1;
};

extern template class DistributedGrid<float>;
extern template class DistributedGrid<double>;

}  // namespace hashphase
