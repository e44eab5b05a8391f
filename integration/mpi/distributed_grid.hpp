// SPDX-License-Identifier: Zlib
#pragma once

// A grid over the processes of an MPI program: exact pairs and queries over all of them, each pair once.
//
//     DistributedGrid<float> grid(MPI_COMM_WORLD);             // by all ranks together
//     const ProxyId proxy = grid.add(GlobalId{number}, box);   // on any rank
//     grid.move(proxy, box);                                   // for what lives here and has moved
//     const RankChanges changes = grid.update();               // by all ranks together, once a frame
//     for (const ProxyPair& pair : changes.pairs.born) { ... }
//
// Objects    live on the rank that owns the place of their min corner: see rank_grid.hpp for objects, ghosts,
//            payloads, pairs and what counts as of when, which are the same here. changes.departed and .arrived tell
//            which objects have moved between ranks: send along what of them is not in the payload.
// Balance    The parts of space follow the work: when the slowest rank has a set share more of it than the mean,
//            update() cuts space again.
// Together   The constructor, update() or begin() and end(), ask(), sendHome(), pairSum() and the destructor are
//            called by all ranks in the same order. All else is local.
// Failure    RankError on all ranks, with a sentence that says which rank has given up, and why: it was left by an
//            exception; ranks have other configurations; another rank has not answered for
//            DistributedConfig::patience, as it hangs or makes other calls; a message is not what it says. The grid
//            is of no more use then, and every further call of all ranks together throws that sentence; MPI_Abort()
//            ends the program. The MPI library ends the program by itself where a process dies.
// Misuse     begin(), end(), ask(), sendHome() and pairSum() in another order, and ask() or pairSum() after a change:
//            RankError on all ranks. Destroy the grid before MPI_Finalize(), and not between begin() and end().
// Threads    Everything from the thread that may call MPI (MPI_THREAD_FUNNELED). Queries of here().grid() may run on
//            several threads.
// Machines   all of one kind: numbers travel as they lie in memory

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

/// Settings, the same on all ranks.
struct DistributedConfig {
    RankGridConfig rankGrid;

    /// Space is cut again when the most loaded rank has more than this times the mean, and more than the error of a
    /// cut, which is made by a sample: 1.05 up to 128 ranks, 1.13 of 1,024, 1.5 of 16,384. Valid: 1 or more; infinity
    /// for never but by balanceNow(), and in the first frame.
    double rebalanceAbove = 1.1;

    /// How long to wait for another rank [s], 0 for ever. Make it longer than any rank ever takes between two
    /// updates.
    double patience = 600;
};

/// What the last frame cost this rank, and how evenly it was shared. Questions do not count.
struct DistributedCost {
    RankCost rankGrid;
    /// The largest load of all ranks, as a multiple of their mean, in the frame before this one.
    double imbalance = 1;
    bool wasRebalanced = false;   ///< space was cut again at the beginning of this frame
    double rebalanceSeconds = 0;  ///< measuring the load, and cutting space
    double packSeconds = 0;       ///< finding what others have to be told
    double waitSeconds = 0;       ///< for messages of other ranks, in end()
    double pairSeconds = 0;       ///< taking what they have told, and finding pairs
};

/// Objects, ghosts and pairs of this rank, and the ways to the others.
template <class Scalar>
class HASHPHASE_MPI_TEMPLATE_EXPORT DistributedGrid {
public:
    using Box = Aabb<Scalar>;

    /// By all ranks of `communicator` together, of which the grid makes a duplicate. The first frame shares space
    /// out by what there is. Throws RankError on all ranks where their configurations differ, and
    /// std::invalid_argument where it is bad.
    explicit DistributedGrid(MPI_Comm communicator, const DistributedConfig& config = {});
    /// The same with a partition to begin with, equal on all ranks: that of a run that goes on, or one that the
    /// program has made of what it knows. Objects that are added where they belong do not have to move.
    /// Throws RankError on all ranks, too, where it is not equal, or not of as many ranks.
    DistributedGrid(MPI_Comm communicator, const Partition<Scalar>& partition,
                    const DistributedConfig& config = {});
    DistributedGrid(const DistributedGrid&) = delete;
    DistributedGrid& operator=(const DistributedGrid&) = delete;
    /// Where an exception is under way, tells the other ranks. Else by all ranks together.
    ~DistributedGrid();

    // --- Objects: see RankGrid -------------------------------------------------------------------

    ProxyId add(GlobalId object, const Box& box, const ProxyGroups& groups = {}) {
        return here_->add(object, box, groups);
    }
    void move(ProxyId id, const Box& box) { here_->move(id, box); }
    void remove(ProxyId id) { here_->remove(id); }
    [[nodiscard]] std::span<std::byte> payload(ProxyId id) { return here_->payload(id); }
    /// This rank's part: objects, ghosts, their payloads and ids, the partition.
    [[nodiscard]] const RankGrid<Scalar>& here() const noexcept { return *here_; }

    // --- Frame -----------------------------------------------------------------------------------

    /// begin() and end(). Throws RankError.
    RankChanges update(ParallelFor parallelFor = serialFor);

    /// Ends the changes of this frame, and sends what other ranks have to know. While that is under way, until
    /// end(), the program does other work: it may ask here(), and changes no boxes and no payloads. Throws RankError.
    void begin();

    /// Takes what other ranks have sent, and returns what has changed. Valid until the next begin(). Throws
    /// RankError. Cost: RankGrid::finish(), a message to each rank concerned, and a barrier.
    RankChanges end(ParallelFor parallelFor = serialFor);

    /// From the next frame on this rank's load is `load` (not negative, asserted; in any unit), such as the
    /// milliseconds that the whole of its step has taken, in place of RankCost::load; nothing for that again. By all
    /// ranks or by none: loads are compared.
    void setLoad(std::optional<double> load);

    /// Cuts space again at the beginning of the frame after the next one, whatever the imbalance. One rank will do.
    void balanceNow() noexcept { wantsCut_ = true; }

    // --- The whole -------------------------------------------------------------------------------

    /// The way back: sends bytes about ghosts, such as forces, to the ranks where their objects live, and returns
    /// what others have sent for objects of this rank, sorted by the rank that has sent. By all ranks together, after
    /// update() and before objects move. Valid until the next call of this or of ask() or begin(). Throws RankError.
    /// Cost: a message to each rank concerned, and a barrier.
    std::span<const Contribution> sendHome(std::span<const Contribution> forGhosts);

    /// Asks all ranks concerned; each rank gets the answers to its own questions. After update(), before the next
    /// change. Valid until the next call. Throws RankError. Cost: two exchanges of messages, each with a barrier.
    Answers<Scalar> ask(std::span<const Question<Scalar>> questions);

    /// The sum over the pairs of all ranks, the same on all of them. After update(), before the next change. Throws
    /// RankError.
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

    // What ranks say of their load at the end of a frame, which all of them know by the beginning of the next one.
    struct Loads {
        std::array<std::uint64_t, 2> mine{};  // and whether space is to be cut in any case
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
