// SPDX-License-Identifier: Zlib
#pragma once

// Zones of interest: volumes that report which proxies enter, stay and leave (paper, "areas of interest"). To keep
// data for zones, use ZoneId::index as array index.
//
// Frame      Move bodies and zones, then call update() once. In each zone, update() reports one event for each proxy
//            that is inside or has just left.
// Grid       Zones are not in the grid. Before you pass another grid to update(), call forgetOccupants(). After
//            Grid::shiftOrigin(), call set() for every zone, with its new position, before the next update():
//            without set(), occupants leave.
// Rollback   A copy of this object is a snapshot, occupants included. To roll back, assign the copy, and call
//            GridSnapshot::restore(). If you repeat the frames after the snapshot, update() reports their events
//            again. Earlier spans are invalid.
// Threads    Const functions may run on several threads at the same time. During other calls, no other thread may
//            use this object. For update(), the thread rules of grid queries hold (grid.hpp).
// Callbacks  Run on all threads of `parallelFor`. Asserted: callbacks do not change or update zones.
// Failure    If memory runs out or a callback throws, occupants do not change. The next update() reports the missed
//            events.
// Bad data   A zone with a NaN or a negative radius contains no proxy. For inverted boxes, see overlaps().
// Misuse     Asserted: ids are valid. An id of another Zones object is not always detected.

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

/// Identifies one zone. As in a ProxyId, indices are small and dense.
struct ZoneId {
    std::uint32_t index = 0;
    std::uint32_t generation = 0;

    /// True for ZoneId{}, which identifies no zone.
    [[nodiscard]] constexpr bool isNull() const noexcept { return generation == 0; }
    friend constexpr auto operator<=>(const ZoneId&, const ZoneId&) = default;
};

/// The part of a proxy that must be in a zone.
enum class Presence : std::uint8_t {
    position,  ///< its position (position_region.hpp)
    box,       ///< any part of its box
};

/// A closed volume: includes its surface. In a ConvexRegion with Containment::inside, the whole box must be inside,
/// whatever `presence` is.
template <class Scalar>
struct Zone {
    std::variant<BoxRegion<Scalar>, SphereRegion<Scalar>, ConvexRegion<Scalar>> shape;
    Presence presence = Presence::position;
};

/// A zone, and a proxy that entered, stayed in or left the zone. Ordered by zone, then by proxy.
struct ZoneEvent {
    ZoneId zone;
    ProxyId proxy;

    friend constexpr auto operator<=>(const ZoneEvent&, const ZoneEvent&) = default;
};

/// The events of an update(). Lists are sorted by zone, then by proxy.
struct ZoneEvents {
    std::span<const ZoneEvent> entered;
    std::span<const ZoneEvent> stayed;
    /// Includes removed proxies, and the occupants of removed zones, with their old ids.
    std::span<const ZoneEvent> left;
};

/// Returns whether a proxy counts as an occupant of a zone. Called only for proxies in the zone. An occupant that the
/// filter refuses leaves the zone.
using ZoneFilter = FunctionRef<bool(ZoneId, ProxyId)>;

[[nodiscard]] inline bool acceptAllInZones(ZoneId /*zone*/, ProxyId /*proxy*/) noexcept {
    return true;
}

/// Returns whether update() searches a zone.
using ZoneChoice = FunctionRef<bool(ZoneId)>;

[[nodiscard]] inline bool allZones(ZoneId /*zone*/) noexcept {
    return true;
}

/// Watches zones, and reports events. Reuses its memory: allocates only if a frame needs more than before.
template <class Scalar>
class HASHPHASE_AI_TEMPLATE_EXPORT Zones {
public:
    // --- Zones -----------------------------------------------------------------------------------

    /// Adds a zone. Until the next update(), the zone has no occupants. Returns its id. Cost: O(1) amortised.
    [[nodiscard]] ZoneId add(const Zone<Scalar>& zone);

    /// Replaces the volume of a zone. The next update() uses the new volume. Cost: O(1).
    void set(ZoneId id, const Zone<Scalar>& zone);

    /// Removes a zone. Its id is never valid again. The next update() reports that its occupants left. Cost:
    /// O(occupants).
    void remove(ZoneId id);

    [[nodiscard]] bool contains(ZoneId id) const noexcept;
    /// The zone as it was added or set. Valid until the next add() or set().
    [[nodiscard]] const Zone<Scalar>& zone(ZoneId id) const;
    [[nodiscard]] std::size_t size() const noexcept { return slots_.size() - freeSlots_.size(); }

    /// Removes the occupants of all zones, but reports no events. Call it before you pass another grid to update().
    void forgetOccupants() noexcept;

    // --- Frame -----------------------------------------------------------------------------------

    /// Finds the proxies in each zone. Returns the events since the last update(), valid until the next update().
    /// Calls `due` once for each zone. If `due` refuses a zone, the zone keeps its occupants, even removed proxies,
    /// and has no events. The next search of the zone reports the changes since its last search. Cost: one
    /// Grid::visit() of each searched zone, and O(occupants).
    ZoneEvents update(const Grid<Scalar>& grid, ZoneFilter filter = acceptAllInZones,
                      ZoneChoice due = allZones, ParallelFor parallelFor = serialFor);

    // --- Queries ---------------------------------------------------------------------------------

    /// The proxies that were in the zone at its last search, sorted by id. Valid until the next update() or
    /// forgetOccupants(), or until the zone is removed. Adding zones does not affect this.
    [[nodiscard]] std::span<const ProxyId> occupants(ZoneId id) const;

    /// Finds the zones whose current shapes contain the point [m]. Replaces `found`, sorted by id. Finds nothing if
    /// the point is not finite. Cost: O(zones).
    void zonesAt(const Vector3<Scalar>& point, std::vector<ZoneId>& found) const;

    /// Cost of the last update(). Its `hits` are boxes that touch zones, including boxes that Presence or the filter
    /// excludes.
    [[nodiscard]] const QueryCost& lastCost() const noexcept { return cost_; }

    /// Bytes held, capacity included. Cost: O(zones).
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

private:
    /// Its moves are noexcept, whatever Eigen's are: so vectors move slots, and spans of occupants stay valid.
    struct Slot {
        Slot() = default;
        explicit Slot(const Zone<Scalar>& watched) : zone(watched) {}
        Slot(const Slot&) = default;
        Slot(Slot&&) noexcept = default;
        Slot& operator=(const Slot&) = default;
        Slot& operator=(Slot&&) noexcept = default;
        ~Slot() = default;

        Zone<Scalar> zone;
        std::uint32_t generation = 0;    // odd while the slot has a zone
        std::vector<ProxyId> occupants;  // of the last search
        std::vector<ProxyId> found;      // found by update()
        QueryCost cost;
        bool isDue = false;  // the current update() searches the zone
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

/// Allows a ZoneId as key of std::unordered_map.
template <>
struct std::hash<hashphase::ZoneId> : hashphase::detail::IdHash<hashphase::ZoneId> {};
