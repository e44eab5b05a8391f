// SPDX-License-Identifier: Zlib
#pragma once

// Saves and restores a grid with its pairs and sweeps: for rollback, replays, training and editors.
//
//     GridSnapshot<float> snapshot;
//     snapshot.save(pairs);     // the grid, its pairs, and the sweeps that they follow
//     ...                       // frames; proxies come and go
//     snapshot.restore(pairs);  // back to the saved state
//
// Restored  Later calls give the same results, order, cost and new ids as after save(). Only populationNumber()
//           changes.
// Ids       Forget ids of proxies added after save(): new proxies may get equal ones.
// Memory    about as many bytes as the grid, kept for the next save(). On std::bad_alloc, restore() changes nothing,
//           and save() leaves the snapshot empty.
// Threads   Needs the grid and this object for itself.
// Misuse    Asserted, else does nothing: not within a query; pass the Pairs if the grid has any; restore() needs a
//           saved state, equal settings, and Sweeps exactly if they were saved.
// Cost      a copy of what the grid, pairs and sweeps hold

#include <broadphase/export.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/pairs.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace hashphase {

namespace detail {
template <class Scalar>
struct GridTwin;
}

/// A saved state of a grid with its pairs and sweeps.
template <class Scalar>
class HASHPHASE_BROADPHASE_TEMPLATE_EXPORT GridSnapshot {
public:
    /// Makes an empty snapshot.
    GridSnapshot() noexcept;
    ~GridSnapshot();
    GridSnapshot(GridSnapshot&& other) noexcept;
    GridSnapshot& operator=(GridSnapshot&& other) noexcept;

    /// Saves a grid without Pairs.
    void save(const Grid<Scalar>& grid);
    /// Saves the pairs, their grid, and the sweeps that they follow, if any.
    void save(const Pairs<Scalar>& pairs);

    /// Restores the saved state into a grid without Pairs: the saved one, or one with equal settings.
    void restore(Grid<Scalar>& grid) const;
    /// Restores the saved state into pairs, their grid, and the sweeps that they follow.
    void restore(Pairs<Scalar>& pairs) const;

    /// Returns why restore() would fail, as a sentence; empty if it can succeed. Ask this after read().
    [[nodiscard]] std::string faultFor(const Grid<Scalar>& grid) const;
    [[nodiscard]] std::string faultFor(const Pairs<Scalar>& pairs) const;

    /// Makes room for restore(), which then allocates nothing, until the pairs or their grid release memory.
    /// Throws std::bad_alloc, and changes nothing. Asserted: as restore().
    void makeRoom(Pairs<Scalar>& pairs) const;

    /// Replaces `bytes` by the snapshot, to send or to keep. Equal states give equal bytes, with a version, a
    /// checksum, and numbers in this processor's format. Asserted: the snapshot is not empty. Cost: O(state).
    void write(std::vector<std::byte>& bytes) const;

    /// Reads what write() wrote. Returns an empty string; or a sentence about the fault in the bytes, and changes
    /// nothing. Whatever the bytes, accepts only states that a grid can have. restore() then restores boxes, ids,
    /// groups, pairs and sweeps, but not which proxies rest. So costs, and the order in which queries find proxies,
    /// may differ. Cost: O(state), and finding all pairs from scratch.
    [[nodiscard]] std::string read(std::span<const std::byte> bytes);

    /// Returns the saved proxy with this index; null when there is none. Cost: O(1).
    [[nodiscard]] ProxyId idAt(std::uint32_t index) const noexcept;
    /// Grid::indexLimit() of the saved grid; 0 for an empty snapshot.
    [[nodiscard]] std::uint32_t indexLimit() const noexcept;

    /// True when there is nothing to restore.
    [[nodiscard]] bool isEmpty() const noexcept { return twin_ == nullptr || !isSaved_; }

    /// Bytes held, including unused capacity.
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

private:
    void save(const Grid<Scalar>& grid, const Pairs<Scalar>* pairs);
    void restore(Grid<Scalar>& grid, Pairs<Scalar>* pairs) const;
    [[nodiscard]] const char* faultFor(const Grid<Scalar>& grid, const Pairs<Scalar>* pairs) const;
    [[nodiscard]] bool isMisused(const Grid<Scalar>& grid, const Pairs<Scalar>* pairs) const;

    std::unique_ptr<detail::GridTwin<Scalar>> twin_;
    bool isSaved_ = false;
};

extern template class GridSnapshot<float>;
extern template class GridSnapshot<double>;

}  // namespace hashphase
