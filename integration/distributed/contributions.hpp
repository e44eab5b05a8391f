// SPDX-License-Identifier: Zlib
#pragma once

// Sends bytes that a rank computes for ghosts, such as contact forces, to the ranks that own these objects.
//
// Transport  Your program carries the parcels, as for RankGrid.
// Frame      All ranks call pack() and finish(), after RankGrid::finish() and before objects move.
// Result     Equal calls give equal results.
// Failure    finish() throws RankError, as RankGrid::finish() does.

#include <integration/distributed/rank_grid.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace hashphase {

/// Bytes about an object.
struct Contribution {
    ProxyId proxy;                     ///< to send: a ghost; received: an object of this rank
    std::span<const std::byte> bytes;  ///< at most 65,536
    std::uint32_t rank = 0;            ///< received: the sending rank; pack() ignores it
};

/// Packs and reads the contributions of one rank. Reuses its memory.
class HASHPHASE_DISTRIBUTED_EXPORT Contributions {
public:
    /// Returns parcels for other ranks, sorted by rank, valid until the next pack(). A ghost may have several
    /// contributions. Asserted: proxies are ghosts, and contributions have at most 65,536 bytes. Others are left out.
    /// Cost: O(contributions).
    template <class Scalar>
    std::span<const Parcel> pack(const RankGrid<Scalar>& grid,
                                 std::span<const Contribution> forGhosts);

    /// Returns other ranks' contributions to objects of this rank, by sending rank, then in the sender's order. Valid
    /// until the next finish(), and only while the parcels exist. Throws RankError. Cost: O(contributions).
    template <class Scalar>
    std::span<const Contribution> finish(const RankGrid<Scalar>& grid,
                                         std::span<const Parcel> received);

private:
    std::vector<detail::ByteWriter> writers_;  // by rank
    std::vector<std::uint32_t> destinations_;
    std::vector<Parcel> parcels_;
    std::vector<Contribution> received_;
};

}  // namespace hashphase
