// SPDX-License-Identifier: Zlib
#include <integration/mpi/detail/sparse_exchange.hpp>

#include <broadphase/diagnostics.hpp>

#include <algorithm>
#include <utility>

namespace hashphase::detail {

SparseExchange::~SparseExchange() {
    for (std::size_t i = 0; i < sends_.size(); ++i) {
        if (sends_[i] != MPI_REQUEST_NULL) {
            Ranks::abandon(std::move(sent_[i].bytes), sends_[i]);
        }
    }
}

void SparseExchange::start(std::span<const Parcel> parcels) {
    HASHPHASE_ASSERT(!isUnderWay_, "One exchange ends before the next one begins.");
    ++number_;
    isUnderWay_ = true;
    sent_.clear();
    sends_.clear();
    received_.clear();
    parcels_.clear();
    for (const Parcel& parcel : parcels) {
        for (std::size_t at = 0; at < parcel.bytes.size(); at += longestMessage) {
            const auto piece =
                parcel.bytes.subspan(at, std::min(longestMessage, parcel.bytes.size() - at));
            sent_.push_back({parcel.rank, {piece.begin(), piece.end()}});
        }
    }
    for (const Message& message : sent_) {
        sends_.push_back(MPI_REQUEST_NULL);
        ranks_.check(MPI_Issend(message.bytes.data(), static_cast<int>(message.bytes.size()),
                                MPI_BYTE, static_cast<int>(message.rank), tag(),
                                ranks_.communicator(), &sends_.back()),
                     "MPI_Issend");
    }
    ranks_.restartClock();
}

bool SparseExchange::poll() {
    if (!isUnderWay_) {
        return true;
    }
    // What has come.
    for (;;) {
        int isThere = 0;
        MPI_Status status;
        MPI_Message message = MPI_MESSAGE_NULL;
        ranks_.check(
            MPI_Improbe(MPI_ANY_SOURCE, tag(), ranks_.communicator(), &isThere, &message, &status),
            "MPI_Improbe");
        if (isThere == 0) {
            break;
        }
        receive(message, status);
    }
    // What this rank has sent, and what all have.
    if (barrier_ == MPI_REQUEST_NULL) {
        int areDone = 1;
        if (!sends_.empty()) {
            ranks_.check(MPI_Testall(static_cast<int>(sends_.size()), sends_.data(), &areDone,
                                     MPI_STATUSES_IGNORE),
                         "MPI_Testall");
        }
        if (areDone == 0) {
            return false;
        }
        sent_.clear();
        sends_.clear();
        ranks_.check(MPI_Ibarrier(ranks_.communicator(), &barrier_), "MPI_Ibarrier");
    }
    if (!ranks_.isDone(barrier_)) {
        return false;
    }
    isUnderWay_ = false;
    barrier_ = MPI_REQUEST_NULL;
    // Pieces of a parcel have come in order; which rank was first does not matter.
    std::stable_sort(received_.begin(), received_.end(),
                     [](const Message& a, const Message& b) { return a.rank < b.rank; });
    for (std::size_t i = 0; i < received_.size();) {
        std::size_t end = i + 1;
        for (; end < received_.size() && received_[end].rank == received_[i].rank; ++end) {
            received_[i].bytes.insert(received_[i].bytes.end(), received_[end].bytes.begin(),
                                      received_[end].bytes.end());
        }
        parcels_.push_back({received_[i].rank, received_[i].bytes});
        i = end;
    }
    return true;
}

void SparseExchange::receive(MPI_Message message, const MPI_Status& status) {
    int size = 0;
    ranks_.check(MPI_Get_count(&status, MPI_BYTE, &size), "MPI_Get_count");
    received_.push_back({static_cast<std::uint32_t>(status.MPI_SOURCE),
                         std::vector<std::byte>(static_cast<std::size_t>(size))});
    ranks_.check(
        MPI_Mrecv(received_.back().bytes.data(), size, MPI_BYTE, &message, MPI_STATUS_IGNORE),
        "MPI_Mrecv");
    ranks_.restartClock();
}

void SparseExchange::finish(const char* doing) {
    while (!poll()) {
        ranks_.idle(doing);
    }
}

}  // namespace hashphase::detail
