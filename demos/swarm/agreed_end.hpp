// SPDX-License-Identifier: Zlib
#pragma once

// An interruption of one rank ends the frames of all.

#include <demos/system/interruption.hpp>
#include <integration/mpi/detail/ranks.hpp>

#include <mpi.h>

#include <memory>
#include <utility>

namespace hashphase::demos {

/// Whether a rank was asked to end, known on all ranks in the same frame. No rank waits for it: what is said in a
/// frame is known in the next one. RankError: a rank has not answered for too long.
class AgreedEnd {
public:
    /// By all ranks of `communicator` together; `patience` is how long to wait for another rank [s], 0 for ever.
    AgreedEnd(MPI_Comm communicator, double patience)
        : said_(std::make_shared<Said>(communicator, patience, "for all ranks to begin")) {}
    AgreedEnd(const AgreedEnd&) = delete;
    AgreedEnd& operator=(const AgreedEnd&) = delete;
    ~AgreedEnd() {
        if (request_ != MPI_REQUEST_NULL) {  // an exception ends the frames
            detail::Ranks::abandon(said_);
        }
    }

    /// Once a frame.
    [[nodiscard]] bool isCalledFor() {
        const bool isCalled = take();
        said_->here = isInterrupted() ? 1 : 0;
        said_->check(MPI_Iallreduce(&said_->here, &said_->anywhere, 1, MPI_INT, MPI_MAX,
                                    said_->communicator(), &request_),
                     "MPI_Iallreduce");
        return isCalled;
    }

    /// What was said last, after the last frame.
    [[nodiscard]] bool take() {
        said_->wait(std::exchange(request_, MPI_REQUEST_NULL), said_,
                    "to hear whether to end the frames");
        return said_->anywhere != 0;
    }

private:
    /// What MPI reads and writes, with the communicator.
    struct Said : detail::Ranks {
        using Ranks::Ranks;

        int here = 0;
        int anywhere = 0;
    };

    std::shared_ptr<Said> said_;
    MPI_Request request_ = MPI_REQUEST_NULL;
};

}  // namespace hashphase::demos
