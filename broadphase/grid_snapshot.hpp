// SPDX-License-Identifier: Zlib
#pragma once

// Saves and restores a grid with its pairs and sweeps: for rollback, replays, training and editors.
//
//     GridSnapshot<float> snapshot;
//     snapshot.save(pairs);     // saves the grid, its Pairs, and their Sweeps
//     ...                       // frames that add, move and remove proxies
//     snapshot.restore(pairs);  // back to the saved state
//
// Restored  After restore(), calls give the same results, order, cost and new ids as after save(). Only
//           populationNumber() differs. If read() filled the snapshot, order and cost may differ, too.
// Ids       After restore(), forget ids of proxies that were added after save(): new proxies may get equal ids.
// Memory    about as many bytes as the grid, its Pairs and Sweeps; the snapshot keeps its memory for the next save().
//           On std::bad_alloc, restore() changes nothing, and save() leaves the snapshot empty.
// Threads   During a call, no other thread may use the grid or this object.
// Misuse    Asserted: this thread runs no query; if the grid has Pairs, you pass the Pairs. restore() needs a saved
//           state and an equal GridConfig. It needs Pairs if and only if Pairs were saved, and Sweeps if and only if
//           Sweeps were saved. If a condition is broken, the call does nothing.
// Cost      O(data of the grid, its Pairs and Sweeps)

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

    /// Saves a grid that has no Pairs.
    void save(const Grid<Scalar>& grid);
    /// Saves the Pairs, their grid, and their Sweeps, if any.
    void save(const Pairs<Scalar>& pairs);

    /// Restores the saved state into a grid that has no Pairs: the saved grid, or another with an equal GridConfig.
    void restore(Grid<Scalar>& grid) const;
    /// Restores the saved state into the Pairs, their grid, and their Sweeps, if any.
    void restore(Pairs<Scalar>& pairs) const;

    /// Returns a sentence that explains why restore() would fail; empty if it can succeed. Useful after read().
    [[nodiscard]] std::string faultFor(const Grid<Scalar>& grid) const;
    [[nodiscard]] std::string faultFor(const Pairs<Scalar>& pairs) const;

    /// Allocates the memory for restore(). Afterwards, restore() allocates nothing until the Pairs or their grid
    /// release memory. On std::bad_alloc, changes nothing. Asserted: as for restore().
    void makeRoom(Pairs<Scalar>& pairs) const;

    /// Replaces the content of `bytes` with the snapshot, for sending or storing. Equal states give equal bytes. The
    /// bytes have a version, a checksum, and numbers in this processor's format. Asserted: the snapshot is not empty.
    /// Cost: O(state).
    void write(std::vector<std::byte>& bytes) const;

    /// Reads bytes that write() made, and returns an empty string. If the bytes are faulty, changes nothing, and
    /// returns a sentence about the fault. Whatever the bytes contain, accepts only states that a grid can have.
    /// Cost: O(state), plus finding all pairs from scratch.
    /// After read(), restore() restores boxes, ids, groups, pairs and sweeps, but not which proxies rest. So costs,
    /// and the order in which queries find proxies, may differ.
    [[nodiscard]] std::string read(std::span<const std::byte> bytes);

    /// Returns the id of the saved proxy with this index; a null id if there is none. Cost: O(1).
    [[nodiscard]] ProxyId idAt(std::uint32_t index) const noexcept;
    /// Grid::indexLimit() of the saved grid; 0 for an empty snapshot.
    [[nodiscard]] std::uint32_t indexLimit() const noexcept;

    /// True when the snapshot holds no saved state.
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
