// SPDX-License-Identifier: Zlib
#pragma once

// Packs bytes, such as contact forces, that a rank (process) computes for ghosts. Ghosts are copies of other ranks'
// objects. The bytes go to the ranks that own these objects.
//
// Transport  Your program sends the parcels, as for RankGrid.
// Frame      All ranks call pack() and finish(), after RankGrid::finish() and before the next change on any rank.
// Result     Deterministic: equal calls give equal results.
// Failure    finish() throws RankError if a parcel is invalid.

#include <integration/distributed/rank_grid.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace hashphase {

/// Bytes about an object.
struct Contribution {
    /// A ghost if passed to pack(), an object of this rank if returned by finish().
    ProxyId proxy;
    std::span<const std::byte> bytes;  ///< at most 65,536 bytes
    std::uint32_t rank = 0;            ///< from finish(): the sender; ignored by pack()
};

/// Packs the contributions that one rank sends, and reads the contributions that it receives. Reuses its memory.
class HASHPHASE_DISTRIBUTED_EXPORT Contributions {
public:
    /// Returns parcels for other ranks, sorted by receiver, valid until the next pack(). A ghost may have several
    /// contributions. Asserted: each proxy is a ghost, and each contribution has at most 65,536 bytes. Without assertions,
    /// leaves out invalid contributions. Cost: O(contributions).
    template <class Scalar>
    std::span<const Parcel> pack(const RankGrid<Scalar>& grid,
                                 std::span<const Contribution> forGhosts);

    /// Returns other ranks' contributions to objects of this rank, sorted by sender. Contributions of one sender keep
    /// their order. Valid until the next finish(), and only while the bytes of `received` exist. Throws RankError.
    /// Cost: O(contributions).
    template <class Scalar>
    std::span<const Contribution> finish(const RankGrid<Scalar>& grid,
                                         std::span<const Parcel> received);

private:
    std::vector<detail::ByteWriter> writers_;  // index: rank
    std::vector<std::uint32_t> destinations_;
    std::vector<Parcel> parcels_;
    std::vector<Contribution> received_;
};

}  // namespace hashphase
