// SPDX-License-Identifier: Zlib
#include <integration/mpi/detail/ranks.hpp>

#include <exception>
#include <thread>
#include <utility>
#include <vector>

namespace hashphase::detail {
namespace {

std::vector<std::shared_ptr<void>>& abandonedBuffers() {
    static std::vector<std::shared_ptr<void>> buffers;
    return buffers;
}

}  // namespace

bool Ranks::isMpiReady() noexcept {
    int isReady = 0;
    int isOver = 0;
    MPI_Initialized(&isReady);
    MPI_Finalized(&isOver);
    return isReady != 0 && isOver == 0;
}

Ranks::Ranks(MPI_Comm communicator, double seconds, const char* doing) : seconds_(seconds) {
    if (!isMpiReady()) {
        throw RankError(
            "DistributedGrid: MPI is not running. Make the grid after MPI_Init() and before "
            "MPI_Finalize().");
    }
    if (communicator == MPI_COMM_NULL) {
        throw RankError(
            "DistributedGrid: the communicator is MPI_COMM_NULL. Pass the communicator of the "
            "ranks that share the grid.");
    }
    restartClock();
    int rank = 0;
    int count = 1;
    MPI_Comm_rank(communicator, &rank);
    MPI_Comm_size(communicator, &count);
    rank_ = static_cast<std::uint32_t>(rank);
    count_ = static_cast<std::uint32_t>(count);
    MPI_Request duplication = MPI_REQUEST_NULL;
    const auto duplicate = std::make_shared<MPI_Comm>(MPI_COMM_NULL);
    check(MPI_Comm_idup(communicator, duplicate.get(), &duplication), "MPI_Comm_idup");
    wait(duplication, duplicate, doing);
    communicator_ = *duplicate;
    MPI_Comm_set_errhandler(communicator_, MPI_ERRORS_RETURN);
}

Ranks::~Ranks() {
    // What has failed may have messages under way, for which nobody waits.
    if (failure_.empty() && isMpiReady()) {
        MPI_Comm_free(&communicator_);
    }
}

void Ranks::check(int code, const char* call) {
    if (code == MPI_SUCCESS) {
        return;
    }
    std::string text(MPI_MAX_ERROR_STRING, '\0');
    int length = 0;
    MPI_Error_string(code, text.data(), &length);
    text.resize(static_cast<std::size_t>(length));
    fail(std::string(call) + " failed: " + text);
}

bool Ranks::isDone(MPI_Request& request) {
    int isDone = 0;
    check(MPI_Test(&request, &isDone, MPI_STATUS_IGNORE), "MPI_Test");
    return isDone != 0;
}

void Ranks::wait(MPI_Request request, const std::shared_ptr<void>& buffer, const char* doing) {
    try {
        restartClock();
        while (!isDone(request)) {
            idle(doing);
        }
    } catch (...) {
        abandon(buffer);
        throw;
    }
}

void Ranks::idle(const char* doing) {
    listen();
    const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - since_;
    if (seconds_ > 0 && waited.count() > seconds_) {
        fail("It waited " + std::to_string(static_cast<int>(waited.count())) + " s " + doing +
             ". Another rank stopped, is slow, or made other calls: see its output, or raise the "
             "patience (DistributedConfig::patience).");
    }
    std::this_thread::yield();
}

void Ranks::listen() {
    if (communicator_ == MPI_COMM_NULL) {
        return;
    }
    int isThere = 0;
    MPI_Status status;
    MPI_Message message = MPI_MESSAGE_NULL;
    if (MPI_Improbe(MPI_ANY_SOURCE, kFailureTag, communicator_, &isThere, &message, &status) !=
            MPI_SUCCESS ||
        isThere == 0) {
        return;
    }
    int size = 0;
    MPI_Get_count(&status, MPI_CHAR, &size);
    std::string text(static_cast<std::size_t>(size), '\0');
    MPI_Mrecv(text.data(), size, MPI_CHAR, &message, MPI_STATUS_IGNORE);
    failure_ = text;  // whoever sent it has told all others
    throw RankError(text);
}

void Ranks::tellFailure(const std::string& sentence) noexcept {
    if (!failure_.empty()) {
        return;
    }
    try {
        failure_ = "Rank " + std::to_string(rank_) + " of " + std::to_string(count_) +
                   " gave up. " + sentence;
        if (communicator_ == MPI_COMM_NULL || !isMpiReady()) {
            return;
        }
        const auto text = std::make_shared<std::string>(failure_);
        abandon(text);
        for (std::uint32_t rank = 0; rank < count_; ++rank) {
            MPI_Request request = MPI_REQUEST_NULL;
            if (rank != rank_) {
                MPI_Isend(text->data(), static_cast<int>(text->size()), MPI_CHAR,
                          static_cast<int>(rank), kFailureTag, communicator_, &request);
            }
        }
    } catch (const std::exception&) {
        failure_ = "no memory";  // short enough to need none; the others lose their patience
    }
}

void Ranks::fail(const std::string& sentence) {
    tellFailure(sentence);
    throw RankError(failure_);
}

void Ranks::abandon(std::shared_ptr<void> buffer) noexcept {
    try {
        abandonedBuffers().push_back(buffer);
    } catch (const std::exception&) {
        static_cast<void>(new std::shared_ptr<void>(std::move(buffer)));
    }
}

}  // namespace hashphase::detail
