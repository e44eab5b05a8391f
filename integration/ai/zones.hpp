// SPDX-License-Identifier: Zlib
#pragma once

// Zones of interest: volumes that report which proxies enter, stay and leave (paper, "areas of interest"). Keep your
// data about zones by ZoneId::index.
//
// Frame      Move bodies and zones, then update() once. A proxy in a zone, or that left it, is in one event of that
//            zone.
// Grid       Zones are not in the grid. Pass the same grid always, or call forgetOccupants() before another one.
//            After Grid::shiftOrigin(), set() every zone to its new place before the next update(): then occupants
//            stay.
// Rollback   A copy is a snapshot with occupants. Assign it together with GridSnapshot::restore(): the next update()
//            repeats its events. Earlier spans are invalid.
// Threads    Const functions may run on any number of threads. All else needs this object for itself; update() reads
//            the grid, as queries do.
// Callbacks  Asked on all threads. Asserted: they neither change nor update zones.
// Failure    If memory runs out or a callback throws, nothing has happened: the next update() reports the same
//            events.
// Bad data   A zone with a NaN or a negative radius holds no proxy. For inverted boxes, see overlaps().
// Misuse     Asserted: ids are valid. An id of other Zones may pass for one of these.

#include <broadphase/convex_region.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/parallel_for.hpp>
#include <broadphase/position_region.hpp>
#include <integration/ai/export.hpp>

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <variant>
#include <vector>

namespace hashphase {

/// Names one zone; zero is null. As in a ProxyId, `index` is small and dense.
struct ZoneId {
    std::uint32_t index = 0;
    std::uint32_t generation = 0;

    /// True for ZoneId{}, which names no zone.
    [[nodiscard]] constexpr bool isNull() const noexcept { return generation == 0; }
    friend constexpr auto operator<=>(const ZoneId&, const ZoneId&) = default;
};

/// The part of a proxy that must be in a zone.
enum class Presence : std::uint8_t {
    position,  ///< its position (position_region.hpp)
    box,       ///< any part of its box
};

/// A closed volume. A ConvexRegion with Containment::inside needs the whole box inside.
template <class Scalar>
struct Zone {
    std::variant<BoxRegion<Scalar>, SphereRegion<Scalar>, ConvexRegion<Scalar>> shape;
    Presence presence = Presence::position;
};

/// A zone, and a proxy that entered, stayed or left. Ordered by zone, then by proxy.
struct ZoneEvent {
    ZoneId zone;
    ProxyId proxy;

    friend constexpr auto operator<=>(const ZoneEvent&, const ZoneEvent&) = default;
};

/// The events between two updates, each list sorted by zone, then by proxy.
struct ZoneEvents {
    std::span<const ZoneEvent> entered;
    std::span<const ZoneEvent> stayed;
    /// Includes removed proxies and zones, by their old ids.
    std::span<const ZoneEvent> left;
};

/// Returns whether a proxy counts in a zone. Asked only about proxies in the zone. A proxy that it accepted before
/// and refuses now leaves the zone.
using ZoneFilter = FunctionRef<bool(ZoneId, ProxyId)>;

[[nodiscard]] inline bool acceptAllInZones(ZoneId /*zone*/, ProxyId /*proxy*/) noexcept {
    return true;
}

/// Returns whether an update searches a zone.
using ZoneChoice = FunctionRef<bool(ZoneId)>;

[[nodiscard]] inline bool allZones(ZoneId /*zone*/) noexcept {
    return true;
}

/// Watches zones. Keeps its memory: a frame like the last one allocates nothing.
template <class Scalar>
class HASHPHASE_AI_TEMPLATE_EXPORT Zones {
public:
    // --- Zones -----------------------------------------------------------------------------------

    /// Adds a zone, empty until the next update(). Returns its id. Cost: O(1) amortised.
    [[nodiscard]] ZoneId add(const Zone<Scalar>& zone);

    /// Moves, resizes or reshapes a zone, for the next update(). Cost: O(1).
    void set(ZoneId id, const Zone<Scalar>& zone);

    /// Removes a zone. Its id is never valid again. Its occupants leave in the next update(). Cost: O(occupants).
    void remove(ZoneId id);

    [[nodiscard]] bool contains(ZoneId id) const noexcept;
    [[nodiscard]] const Zone<Scalar>& zone(ZoneId id) const;
    [[nodiscard]] std::size_t size() const noexcept { return slots_.size() - freeSlots_.size(); }

    /// Empties all zones without events. Call it before another grid replaces this one.
    void forgetOccupants() noexcept;

    // --- Frame -----------------------------------------------------------------------------------

    /// Finds the proxies in each zone. Returns the changes since the last update(), valid until the next. `due` is
    /// asked once about each zone. A refused zone keeps its occupants, removed ones included, and has no events; its
    /// next search reports all changes since. Cost: Grid::visit() of each due zone, and the sum of the occupants.
    ZoneEvents update(const Grid<Scalar>& grid, ZoneFilter filter = acceptAllInZones,
                      ZoneChoice due = allZones, ParallelFor parallelFor = serialFor);

    // --- Queries ---------------------------------------------------------------------------------

    /// The zone's proxies at the last update(), sorted by id. Valid until the next update().
    [[nodiscard]] std::span<const ProxyId> occupants(ZoneId id) const;

    /// Finds the zones that contain the point [m] now. Replaces `found`, sorted by id; empty if the point is not
    /// finite. Cost: O(zones).
    void zonesAt(const Vector3<Scalar>& point, std::vector<ZoneId>& found) const;

    /// Cost of the last update(). Hits are boxes found, before presence and filter.
    [[nodiscard]] const QueryCost& lastCost() const noexcept { return cost_; }

    /// Bytes held, capacity included. Cost: O(zones).
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

private:
    struct Slot {
        Zone<Scalar> zone;
        std::uint32_t generation = 0;    // odd while the slot has a zone
        std::vector<ProxyId> occupants;  // at the last update
        std::vector<ProxyId> found;      // by the one under way
        QueryCost cost;
        bool isDue = false;  // the update under way looks into it
    };

    [[nodiscard]] const Slot& slot(ZoneId id) const;
    [[nodiscard]] static bool isAlive(const Slot& slot) noexcept {
        return (slot.generation & 1) != 0;
    }
    void findAll(const Grid<Scalar>& grid, ZoneFilter filter, ZoneChoice due,
                 ParallelFor parallelFor);
    void tellApart(ZoneId id, const Slot& slot);

    std::vector<Slot> slots_;
    std::vector<std::uint32_t> freeSlots_;
    std::vector<ZoneEvent> entered_;
    std::vector<ZoneEvent> stayed_;
    std::vector<ZoneEvent> left_;
    std::vector<ZoneEvent> abandoned_;  // occupants of zones removed since the last update
    QueryCost cost_;
};

extern template class Zones<float>;
extern template class Zones<double>;

}  // namespace hashphase

/// For keys of std::unordered_map.
template <>
struct std::hash<hashphase::ZoneId> : hashphase::detail::IdHash<hashphase::ZoneId> {};
