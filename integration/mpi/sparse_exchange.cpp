// SPDX-License-Identifier: Zlib
#include <integration/mpi/detail/sparse_exchange.hpp>

#include <broadphase/diagnostics.hpp>

#include <algorithm>
#include <deque>
#include <utility>

namespace hashphase::detail {

/// What MPI reads and writes; kept where an exchange does not end.
struct ExchangeBuffers {
    std::vector<RankMessage> sent;
    std::vector<MPI_Request> sends;
    std::deque<RankMessage> received;  // none moves while MPI writes to it
    std::vector<MPI_Request> receives;
};

SparseExchange::SparseExchange(Ranks& ranks)
    : ranks_(ranks), buffers_(std::make_shared<ExchangeBuffers>()) {}

SparseExchange::~SparseExchange() {
    if (isUnderWay_) {
        Ranks::abandon(buffers_);
    }
}

void SparseExchange::start(std::span<const Parcel> parcels) {
    HASHPHASE_ASSERT(!isUnderWay_,
                     "SparseExchange::start() was called during an exchange. Call finish() first.");
    ++number_;
    isUnderWay_ = true;
    ExchangeBuffers& buffers = *buffers_;
    buffers = {};
    for (const Parcel& parcel : parcels) {
        for (std::size_t at = 0; at < parcel.bytes.size(); at += longestMessage_) {
            const auto piece =
                parcel.bytes.subspan(at, std::min(longestMessage_, parcel.bytes.size() - at));
            buffers.sent.push_back({parcel.rank, {piece.begin(), piece.end()}});
        }
    }
    for (const RankMessage& message : buffers.sent) {
        buffers.sends.push_back(MPI_REQUEST_NULL);
        ranks_.check(MPI_Issend(message.bytes.data(), static_cast<int>(message.bytes.size()),
                                MPI_BYTE, static_cast<int>(message.rank), tag(),
                                ranks_.communicator(), &buffers.sends.back()),
                     "MPI_Issend");
    }
}

bool SparseExchange::poll() {
    if (!isUnderWay_) {
        return true;
    }
    receiveWhatHasCome();
    // When all that this rank has sent is being received, and so it is of all ranks.
    if (barrier_ == MPI_REQUEST_NULL) {
        if (!areDone(buffers_->sends)) {
            return false;
        }
        ranks_.check(MPI_Ibarrier(ranks_.communicator(), &barrier_), "MPI_Ibarrier");
    }
    if (!hasMet_) {
        hasMet_ = ranks_.isDone(barrier_);
    }
    if (!hasMet_ || !areDone(buffers_->receives)) {
        return false;
    }
    isUnderWay_ = false;
    hasMet_ = false;
    barrier_ = MPI_REQUEST_NULL;
    joinPieces();
    return true;
}

bool SparseExchange::areDone(std::vector<MPI_Request>& requests) {
    int areDone = 1;
    if (!requests.empty()) {
        ranks_.check(MPI_Testall(static_cast<int>(requests.size()), requests.data(), &areDone,
                                 MPI_STATUSES_IGNORE),
                     "MPI_Testall");
    }
    return areDone != 0;
}

void SparseExchange::receiveWhatHasCome() {
    for (;;) {
        int isThere = 0;
        MPI_Status status;
        MPI_Message message = MPI_MESSAGE_NULL;
        ranks_.check(
            MPI_Improbe(MPI_ANY_SOURCE, tag(), ranks_.communicator(), &isThere, &message, &status),
            "MPI_Improbe");
        if (isThere == 0) {
            return;
        }
        int size = 0;
        ranks_.check(MPI_Get_count(&status, MPI_BYTE, &size), "MPI_Get_count");
        RankMessage& received = buffers_->received.emplace_back();
        received.rank = static_cast<std::uint32_t>(status.MPI_SOURCE);
        received.bytes.resize(static_cast<std::size_t>(size));
        buffers_->receives.push_back(MPI_REQUEST_NULL);
        ranks_.check(
            MPI_Imrecv(received.bytes.data(), size, MPI_BYTE, &message, &buffers_->receives.back()),
            "MPI_Imrecv");
        ranks_.restartClock();
    }
}

// Pieces of a parcel have come in their order; which rank was first does not matter.
void SparseExchange::joinPieces() {
    joined_.clear();
    parcels_.clear();
    std::stable_sort(buffers_->received.begin(), buffers_->received.end(),
                     [](const RankMessage& a, const RankMessage& b) { return a.rank < b.rank; });
    for (RankMessage& piece : buffers_->received) {
        if (joined_.empty() || joined_.back().rank != piece.rank) {
            joined_.push_back(std::move(piece));
        } else {
            joined_.back().bytes.insert(joined_.back().bytes.end(), piece.bytes.begin(),
                                        piece.bytes.end());
        }
    }
    for (const RankMessage& message : joined_) {
        parcels_.push_back({message.rank, message.bytes});
    }
    *buffers_ = {};
}

void SparseExchange::finish(const char* doing) {
    ranks_.restartClock();
    while (!poll()) {
        ranks_.idle(doing);
    }
}

}  // namespace hashphase::detail
