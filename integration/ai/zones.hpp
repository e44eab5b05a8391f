// SPDX-License-Identifier: Zlib
#pragma once

// Zones of interest: volumes that report which proxies enter, stay and leave (paper, "areas of interest"). Index your
// own data about zones by ZoneId::index.
//
// Frame      Move bodies and zones, then call update() once. A proxy that is in a zone, or has left it, is in exactly
//            one event of that zone.
// Grid       Zones are not in the grid. Always pass the same grid, or call forgetOccupants() before you pass another.
//            After Grid::shiftOrigin(), set() every zone to its new place before the next update(), so occupants
//            stay.
// Rollback   A copy is a snapshot, occupants included. To roll back, assign it, and call GridSnapshot::restore(): the
//            next update() repeats the events. Earlier spans are invalid.
// Threads    Const functions may run on several threads at once. During other calls, no other thread may use this
//            object. update() is a query of the grid.
// Callbacks  run on all threads of `parallelFor`. Asserted: they do not change or update zones.
// Failure    If memory runs out or a callback throws, no zone changes. The next update() reports the missed events.
// Bad data   A zone with a NaN or a negative radius contains no proxy. For inverted boxes, see overlaps().
// Misuse     Asserted: ids are valid. An id of another Zones object may go unnoticed.

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

/// A closed volume. A ConvexRegion with Containment::inside needs the whole box inside.
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

/// The events between two updates. Lists are sorted by zone, then by proxy.
struct ZoneEvents {
    std::span<const ZoneEvent> entered;
    std::span<const ZoneEvent> stayed;
    /// Includes removed proxies and removed zones, under their old ids.
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

/// Watches zones. Reuses its memory: a frame that needs no more than before allocates nothing.
template <class Scalar>
class HASHPHASE_AI_TEMPLATE_EXPORT Zones {
public:
    // --- Zones -----------------------------------------------------------------------------------

    /// Adds a zone, without occupants until the next update(). Returns its id. Cost: O(1) amortised.
    [[nodiscard]] ZoneId add(const Zone<Scalar>& zone);

    /// Moves, resizes or reshapes a zone. The next update() uses the new shape. Cost: O(1).
    void set(ZoneId id, const Zone<Scalar>& zone);

    /// Removes a zone. Its id is never valid again. The next update() reports its occupants as left. Cost:
    /// O(occupants).
    void remove(ZoneId id);

    [[nodiscard]] bool contains(ZoneId id) const noexcept;
    [[nodiscard]] const Zone<Scalar>& zone(ZoneId id) const;
    [[nodiscard]] std::size_t size() const noexcept { return slots_.size() - freeSlots_.size(); }

    /// Forgets the occupants of all zones, without events. Call it before you pass another grid.
    void forgetOccupants() noexcept;

    // --- Frame -----------------------------------------------------------------------------------

    /// Finds the proxies in each zone. Returns the changes since the last update(), valid until the next update().
    /// Calls `due` once for each zone. If `due` refuses a zone, the zone keeps its occupants, even removed proxies,
    /// and has no events. The zone's next search reports all changes since. Cost: one Grid::visit() of each due zone,
    /// and O(occupants).
    ZoneEvents update(const Grid<Scalar>& grid, ZoneFilter filter = acceptAllInZones,
                      ZoneChoice due = allZones, ParallelFor parallelFor = serialFor);

    // --- Queries ---------------------------------------------------------------------------------

    /// The proxies that were in the zone at its last search, sorted by id. Valid until the next update().
    [[nodiscard]] std::span<const ProxyId> occupants(ZoneId id) const;

    /// Finds the zones whose present shapes contain the point [m]. Replaces `found`, sorted by id; empty if the point
    /// is not finite. Cost: O(zones).
    void zonesAt(const Vector3<Scalar>& point, std::vector<ZoneId>& found) const;

    /// Cost of the last update(). Its hits are boxes that touch zones, before presence and filter decide.
    [[nodiscard]] const QueryCost& lastCost() const noexcept { return cost_; }

    /// Bytes held, capacity included. Cost: O(zones).
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

private:
    struct Slot {
        Zone<Scalar> zone;
        std::uint32_t generation = 0;    // odd while the slot has a zone
        std::vector<ProxyId> occupants;  // of the last update
        std::vector<ProxyId> found;      // by the update under way
        QueryCost cost;
        bool isDue = false;  // the update under way searches the zone
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
