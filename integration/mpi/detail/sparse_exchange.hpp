// SPDX-License-Identifier: Zlib
#pragma once

// Parcels between ranks that do not know from whom they will get some: each sends what it has, and all know when
// nothing is under way any more. Costs the messages themselves and one barrier, nothing that grows with all
// ranks.
//
// The non-blocking consensus of T. Hoefler, C. Siebert and A. Lumsdaine, "Scalable communication protocols for
// dynamic sparse data exchange", 2010: a synchronous send is complete when it is being received; who has no send
// left enters a barrier that does not block; when all have entered, everything has been received.

#include <integration/mpi/detail/ranks.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace hashphase::detail {

// Not within the class, which is exported: templates of them stay hidden.
struct RankMessage {
    std::uint32_t rank = 0;
    std::vector<std::byte> bytes;
};
struct ExchangeBuffers;

class HASHPHASE_MPI_EXPORT SparseExchange {
public:
    explicit SparseExchange(Ranks& ranks);
    SparseExchange(const SparseExchange&) = delete;
    SparseExchange& operator=(const SparseExchange&) = delete;
    ~SparseExchange();

    /// Begins to send the parcels; copies their bytes. All ranks begin and end their exchanges in the same order, one
    /// after the other (asserted).
    void start(std::span<const Parcel> parcels);

    /// Receives what has come, and returns whether the exchange has ended. Never blocks.
    /// Throws RankError when another rank has given up.
    bool poll();

    [[nodiscard]] bool isUnderWay() const noexcept { return isUnderWay_; }

    /// Polls until the end, from now on with patience. `doing` says in an error what was waited for.
    void finish(const char* doing);

    /// What has been received, sorted by rank. Valid until start().
    [[nodiscard]] std::span<const Parcel> received() const noexcept { return parcels_; }

    /// Longer parcels are sent in pieces, since MPI counts bytes by an int. Valid: 1 to 2^30.
    static void setLongestMessage(std::size_t bytes) noexcept { longestMessage_ = bytes; }

private:
    void receiveWhatHasCome();
    [[nodiscard]] bool areDone(std::vector<MPI_Request>& requests);
    void joinPieces();
    [[nodiscard]] int tag() const noexcept {
        return Ranks::kFirstTag + static_cast<int>(number_ & 1);
    }

    static inline std::size_t longestMessage_ = std::size_t{1} << 30;

    Ranks& ranks_;
    std::uint64_t number_ =
        0;  // of the exchange; the next one may begin elsewhere before this one has ended here
    bool isUnderWay_ = false;
    std::shared_ptr<ExchangeBuffers> buffers_;
    MPI_Request barrier_ = MPI_REQUEST_NULL;
    bool hasMet_ = false;  // at the barrier
    std::vector<RankMessage> joined_;
    std::vector<Parcel> parcels_;
};

}  // namespace hashphase::detail
