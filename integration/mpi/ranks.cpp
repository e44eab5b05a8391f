// SPDX-License-Identifier: Zlib
#include <integration/mpi/detail/ranks.hpp>

#include <thread>
#include <utility>

namespace hashphase::detail {
namespace {

struct Abandoned {
    std::vector<std::byte> bytes;
    MPI_Request request;
};

std::vector<Abandoned>& abandonedMessages() {
    static std::vector<Abandoned> messages;
    return messages;
}

// Why MPI cannot be called, or nothing.
std::string mpiFault() {
    int isReady = 0;
    int isOver = 0;
    MPI_Initialized(&isReady);
    MPI_Finalized(&isOver);
    if (isReady == 0 || isOver != 0) {
        return "A grid over MPI lives between MPI_Init() and MPI_Finalize().";
    }
    return "";
}

}  // namespace

Ranks::Ranks(MPI_Comm communicator, double seconds) : seconds_(seconds) {
    if (const std::string fault = mpiFault(); !fault.empty()) {
        throw RankError(fault);
    }
    if (communicator == MPI_COMM_NULL) {
        throw RankError("A grid over MPI needs a communicator; this is MPI_COMM_NULL.");
    }
    restartClock();
    int rank = 0;
    int count = 1;
    MPI_Comm_rank(communicator, &rank);
    MPI_Comm_size(communicator, &count);
    rank_ = static_cast<std::uint32_t>(rank);
    count_ = static_cast<std::uint32_t>(count);
    MPI_Request duplication = MPI_REQUEST_NULL;
    MPI_Comm duplicate = MPI_COMM_NULL;
    check(MPI_Comm_idup(communicator, &duplicate, &duplication), "MPI_Comm_idup");
    wait(duplication, "for all ranks to make the grid");
    communicator_ = duplicate;
    MPI_Comm_set_errhandler(communicator_, MPI_ERRORS_RETURN);
}

Ranks::~Ranks() {
    // What has failed may have messages under way, for which nobody waits.
    if (failure_.empty() && mpiFault().empty()) {
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

void Ranks::wait(MPI_Request& request, const char* doing) {
    restartClock();
    while (!isDone(request)) {
        idle(doing);
    }
}

void Ranks::idle(const std::string& doing) {
    listen();
    const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - since_;
    if (seconds_ > 0 && waited.count() > seconds_) {
        fail("It has waited " + std::to_string(static_cast<int>(waited.count())) + " s " + doing +
             ": another rank has stopped, or has not made the same calls.");
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
    failure_ =
        "Rank " + std::to_string(rank_) + " of " + std::to_string(count_) + " gave up. " + sentence;
    if (communicator_ == MPI_COMM_NULL || !mpiFault().empty()) {
        return;
    }
    for (std::uint32_t rank = 0; rank < count_; ++rank) {
        if (rank == rank_) {
            continue;
        }
        const auto* begin = reinterpret_cast<const std::byte*>(failure_.data());
        std::vector<std::byte> bytes(begin, begin + failure_.size());
        MPI_Request request = MPI_REQUEST_NULL;
        MPI_Isend(bytes.data(), static_cast<int>(bytes.size()), MPI_CHAR, static_cast<int>(rank),
                  kFailureTag, communicator_, &request);
        abandon(std::move(bytes), request);
    }
}

void Ranks::fail(const std::string& sentence) {
    tellFailure(sentence);
    throw RankError(failure_);
}

void Ranks::abandon(std::vector<std::byte>&& bytes, MPI_Request request) {
    abandonedMessages().push_back({std::move(bytes), request});
}

}  // namespace hashphase::detail
