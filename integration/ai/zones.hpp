// SPDX-License-Identifier: Zlib
#pragma once

// Zones of interest: volumes that know who is in them, and tell who enters, stays and leaves
// (paper, "areas of interest"). What a zone means, the caller keeps by ZoneId::index.
//
// A frame   move bodies and zones, then update() once: every proxy and zone that have to do with
//           each other are in one event.
// Grid      holds the bodies; zones are not filed in it. update() is always given the same one, or after
//           forgetOccupants() another one. After a Grid::shiftOrigin() every zone has to be set() where
//           it is now, before the next update(): who was in it then stays.
// Threads   update() reads the grid, as queries do, and needs this object for itself, as add(), set()
//           and remove() do. All else is const and may be called from any number of threads.
// Failure   Where memory runs out, or a filter throws, nothing has happened: what update() would have
//           told the next one does.
// Bad data  Nobody is in a zone whose shape has a NaN or a negative radius. An inverted box means
//           what overlaps() says.
// Misuse    An id of no zone is asserted; one of other Zones that some zone here has as well is taken for
//           that.

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

/// A value that names one zone; zero is null. As ProxyId: `index` is small and dense.
struct ZoneId {
    std::uint32_t index = 0;
    std::uint32_t generation = 0;

    /// True for ZoneId{}, which names no zone.
    [[nodiscard]] constexpr bool isNull() const noexcept { return generation == 0; }
    friend constexpr auto operator<=>(const ZoneId&, const ZoneId&) = default;
};

/// What of a proxy has to be in a zone.
enum class Presence : std::uint8_t {
    position,  ///< its position (position_region.hpp), and of course its box
    box,       ///< any part of its box
};

/// A closed volume. A ConvexRegion that is made for Containment::inside asks for the whole box.
template <class Scalar>
struct Zone {
    std::variant<BoxRegion<Scalar>, SphereRegion<Scalar>, ConvexRegion<Scalar>> shape;
    Presence presence = Presence::position;
};

struct ZoneEvent {
    ZoneId zone;
    ProxyId proxy;

    friend constexpr auto operator<=>(const ZoneEvent&, const ZoneEvent&) = default;
};

/// What happened between two updates, each list sorted by zone, then proxy.
struct ZoneEvents {
    std::span<const ZoneEvent> entered;
    std::span<const ZoneEvent> stayed;
    /// A proxy or zone that was removed has its old id here.
    std::span<const ZoneEvent> left;
};

/// Says whether a proxy counts in a zone. Asked about those that are in it, on all threads. Whom it
/// refuses now though it did not before has left.
using ZoneFilter = FunctionRef<bool(ZoneId, ProxyId)>;

/// The filter that refuses nobody.
[[nodiscard]] inline bool acceptAllInZones(ZoneId /*zone*/, ProxyId /*proxy*/) noexcept {
    return true;
}

/// Says whether an update looks into a zone.
using ZoneChoice = FunctionRef<bool(ZoneId)>;

[[nodiscard]] inline bool allZones(ZoneId /*zone*/) noexcept {
    return true;
}

/// Watches zones. Keeps its memory: a frame like the last one allocates nothing.
template <class Scalar>
class HASHPHASE_AI_EXPORT Zones {
public:
    // --- Zones -----------------------------------------------------------------------------------

    /// Adds a zone, empty until the next update. Cost: O(1) amortised.
    [[nodiscard]] ZoneId add(const Zone<Scalar>& zone);

    /// Moves, resizes or reshapes a zone, seen by the next update. Cost: O(1).
    void set(ZoneId id, const Zone<Scalar>& zone);

    /// Removes a zone; its id is never valid again. Its occupants leave in the next update. Cost:
    /// O(occupants).
    void remove(ZoneId id);

    [[nodiscard]] bool contains(ZoneId id) const noexcept;
    [[nodiscard]] const Zone<Scalar>& zone(ZoneId id) const;
    [[nodiscard]] std::size_t size() const noexcept { return slots_.size() - freeSlots_.size(); }

    /// Empties all zones, and nobody is told: for the grid to be replaced by another one.
    void forgetOccupants() noexcept;

    // --- Frame -----------------------------------------------------------------------------------

    /// Finds out who is in each zone now, and what has changed since the last update. Valid until
    /// the next one. The result does not depend on `parallelFor`. A zone that `due` leaves out, asked
    /// once for each, keeps its occupants, removed ones included, and has no events: the next update
    /// that looks into it tells all that has changed since the last one that did. Cost: a query for
    /// each zone that is due, at most one test for each zone and proxy (Grid::visit()), and the sum of
    /// the occupants.
    ZoneEvents update(const Grid<Scalar>& grid, ZoneFilter filter = acceptAllInZones,
                      ZoneChoice due = allZones, ParallelFor parallelFor = serialFor);

    // --- Queries ---------------------------------------------------------------------------------

    /// Who was in the zone at the last update, sorted. Valid until the next one.
    [[nodiscard]] std::span<const ProxyId> occupants(ZoneId id) const;

    /// Finds the zones that the point is in now, sorted, in place of what `found` held. None when
    /// the point is not finite. Cost: O(zones).
    void zonesAt(const Vector3<Scalar>& point, std::vector<ZoneId>& found) const;

    /// What the last update() cost; hits are boxes, before presence and filter are asked about.
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
