// SPDX-License-Identifier: Zlib
#pragma once

// The way back: bytes that a rank computes for ghosts, such as contact forces, for the ranks of their objects.
//
// Transport  Your program carries the parcels, as for RankGrid.
// Frame      By all ranks together, after RankGrid::finish() and before objects move.
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
    ProxyId proxy;                     ///< sent: a ghost; received: an object that lives here
    std::span<const std::byte> bytes;  ///< at most 65,536
    std::uint32_t rank = 0;            ///< received: the sender; sent: ignored
};

/// Contributions of one rank, sent and received. Keeps its memory.
class HASHPHASE_DISTRIBUTED_EXPORT Contributions {
public:
    /// Returns parcels for other ranks, sorted by rank, valid until the next call. A ghost may have several
    /// contributions. Asserted: proxies are ghosts, and bytes at most 65,536; others are left out. Cost:
    /// O(contributions).
    template <class Scalar>
    std::span<const Parcel> pack(const RankGrid<Scalar>& grid,
                                 std::span<const Contribution> forGhosts);

    /// Returns other ranks' contributions to objects that live here, by sending rank, then in the sender's order.
    /// Valid until the next call, and as long as the parcels. Throws RankError. Cost: O(contributions).
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
