// SPDX-License-Identifier: Zlib
#pragma once

// A grid as it was at some time, with its pairs and sweeps, to go back to: for rollback, replays, training and
// editors.
//
//     GridSnapshot<float> snapshot;
//     snapshot.save(pairs);     // the grid, its pairs, and the sweeps that they follow
//     ...                       // frames, proxies that come and go
//     snapshot.restore(pairs);  // as if nothing had happened since
//
// What is the same   All: the next calls have the same results, in the same order and at the same cost, as they
//           had after save(), indices and generations of new ids included. populationNumber() alone goes on, so
//           that what clients keep by it is out of date.
// Ids       of proxies added after save() are void after restore(): forget them. New proxies may get equal ones.
// Memory    A snapshot has about as many bytes as the grid, and keeps them: to save again takes none where the
//           grid has not grown. Where memory runs out in restore(), nothing has changed; in save(), the snapshot is
//           empty.
// Threads   Needs the grid and this object for itself.
// Misuse    restore() from an empty snapshot, into a grid with other settings, or without the pairs and sweeps that
//           were saved with it; save() of a grid without its Pairs; and calls within a query are asserted, and do
//           nothing.
// Cost      A copy of what the grid, pairs and sweeps hold.

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

/// Keeps a grid with its pairs and sweeps, and puts it back.
template <class Scalar>
class HASHPHASE_BROADPHASE_TEMPLATE_EXPORT GridSnapshot {
public:
    /// An empty one.
    GridSnapshot() noexcept;
    ~GridSnapshot();
    GridSnapshot(GridSnapshot&& other) noexcept;
    GridSnapshot& operator=(GridSnapshot&& other) noexcept;

    /// Saves a grid that has no Pairs.
    void save(const Grid<Scalar>& grid);
    /// Saves the pairs, their grid, and the sweeps that they follow, if any.
    void save(const Pairs<Scalar>& pairs);

    /// Puts a grid that has no Pairs back to what was saved of it, or of another grid with equal settings.
    void restore(Grid<Scalar>& grid) const;
    /// The same of pairs, their grid and the sweeps that they follow.
    void restore(Pairs<Scalar>& pairs) const;

    /// Says why the snapshot cannot be restored into the grid, or the pairs, in a sentence; empty where it can. To
    /// be asked about a snapshot that was read, which may be of another grid.
    [[nodiscard]] std::string faultFor(const Grid<Scalar>& grid) const;
    [[nodiscard]] std::string faultFor(const Pairs<Scalar>& pairs) const;

    /// Makes room for restore(), which then takes no memory until the pairs, or their grid, have given some back.
    /// Where memory runs out, nothing has changed. Misuse as of restore().
    void makeRoom(Pairs<Scalar>& pairs) const;

    /// Replaces what `bytes` held by the snapshot, which is not empty (asserted): to send or to keep. They begin
    /// with a version and a checksum, and are the same for equal states. Numbers are as this processor has them.
    /// Cost: O(what is saved).
    void write(std::vector<std::byte>& bytes) const;

    /// Takes what was written. Returns an empty string on success. Otherwise a sentence that says what is wrong with
    /// the bytes, and changes nothing. Whatever the bytes, the snapshot that is read is one that a grid can have been
    /// in, or is refused.
    /// What is the same after restore() are boxes, ids, groups, pairs, sweeps and all that follows from these: not
    /// which proxies rest, and so neither costs nor the order in which queries find proxies.
    /// Cost: O(what is saved), and finding all pairs from scratch.
    [[nodiscard]] std::string read(std::span<const std::byte> bytes);

    /// The proxy that had this index; null where none had. Cost: O(1).
    [[nodiscard]] ProxyId idAt(std::uint32_t index) const noexcept;
    /// Grid::indexLimit() of the grid that was saved; 0 where none was.
    [[nodiscard]] std::uint32_t indexLimit() const noexcept;

    /// Whether there is nothing to restore.
    [[nodiscard]] bool isEmpty() const noexcept { return twin_ == nullptr || !isSaved_; }

    /// Bytes held, capacity included.
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
