// SPDX-License-Identifier: Zlib
#pragma once

// The ranks of a communicator, of which any may fail: every wait listens for what the others have to say, and
// ends. A rank that gives up tells all others why.

#include <integration/distributed/rank_grid.hpp>
#include <integration/mpi/export.hpp>

#include <mpi.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace hashphase::detail {

/// A communicator of its own, in which errors come back.
class HASHPHASE_MPI_EXPORT Ranks {
public:
    /// By all ranks of `communicator` together; `seconds` is how long to wait for another rank, 0 for ever.
    /// `doing` completes the error "It waited 30 s ...".
    Ranks(MPI_Comm communicator, double seconds,
          const char* doing = "for all ranks to make the grid");
    Ranks(const Ranks&) = delete;
    Ranks& operator=(const Ranks&) = delete;
    ~Ranks();

    [[nodiscard]] std::uint32_t rank() const noexcept { return rank_; }
    [[nodiscard]] std::uint32_t count() const noexcept { return count_; }
    [[nodiscard]] MPI_Comm communicator() const noexcept { return communicator_; }

    /// Throws RankError where a call has not returned MPI_SUCCESS.
    void check(int code, const char* call);

    /// Waits for a request of which MPI reads and writes `buffer`. `doing` says in an error what was waited for.
    /// Where it throws, the buffer is kept: MPI may still use it.
    void wait(MPI_Request request, const std::shared_ptr<void>& buffer, const char* doing);
    /// Tests a request once.
    [[nodiscard]] bool isDone(MPI_Request& request);

    /// To be called again and again while nothing happens: throws RankError when another rank has given up, or
    /// has not been heard of for too long since restartClock(), and lets others run.
    void idle(const char* doing);
    void listen();
    void restartClock() noexcept { since_ = std::chrono::steady_clock::now(); }

    /// Tells all other ranks why this one gives up. Whoever waits for it throws RankError with the sentence.
    void tellFailure(const std::string& sentence) noexcept;
    /// tellFailure(), and throws RankError.
    [[noreturn]] void fail(const std::string& sentence);
    [[nodiscard]] const std::string& failure() const noexcept { return failure_; }

    /// Keeps what MPI may still use, although nobody waits for it any more, to the end of the program.
    static void abandon(std::shared_ptr<void> buffer) noexcept;

    /// Whether MPI_Init() has been called, and MPI_Finalize() not yet.
    [[nodiscard]] static bool isMpiReady() noexcept;

    static constexpr int kFailureTag = 0;
    static constexpr int kFirstTag = 1;

private:
    MPI_Comm communicator_ = MPI_COMM_NULL;
    std::uint32_t rank_ = 0;
    std::uint32_t count_ = 1;
    double seconds_ = 0;
    std::chrono::steady_clock::time_point since_;
    std::string failure_;  // why this object is of no more use
};

}  // namespace hashphase::detail
