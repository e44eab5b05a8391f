// SPDX-License-Identifier: Zlib
#pragma once

// The way back: what a rank has computed for ghosts, such as forces of contacts, for the ranks where their objects
// live. Knows no transport, as RankGrid.
//
//     for (const Parcel& parcel : contributions.pack(grid, forGhosts)) { send(parcel.rank, parcel.bytes); }
//     for (const Contribution& one : contributions.finish(grid, received)) { force[one.proxy.index] += ... }
//
// Frame     by all ranks together, after RankGrid::finish() and before objects move
// Result    the same for the same calls: sorted by the rank that has sent, then as it has handed them in
// Failure   finish() throws RankError as RankGrid::finish() does

#include <integration/distributed/rank_grid.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace hashphase {

/// Bytes about an object.
struct Contribution {
    ProxyId proxy;  ///< handed in, of a ghost; received, of an object that lives here
    std::span<const std::byte> bytes;  ///< at most 65,536
    std::uint32_t rank = 0;            ///< received, from where; handed in, not read
};

/// The contributions of one rank, and those that it gets. Keeps its memory.
class HASHPHASE_DISTRIBUTED_EXPORT Contributions {
public:
    /// Returns what goes to other ranks, sorted by rank. Several contributions for one ghost are all sent. Proxies
    /// that are no ghosts, and too many bytes, are asserted, and left out. Valid until the next call.
    /// Cost: O(contributions).
    template <class Scalar>
    std::span<const Parcel> pack(const RankGrid<Scalar>& grid,
                                 std::span<const Contribution> forGhosts);

    /// Returns what other ranks have sent for objects that live here. Valid until the next call, and as long as the
    /// parcels. Cost: O(contributions).
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
