// SPDX-License-Identifier: Zlib
#pragma once

// Zones of interest: volumes that know which proxies are in them, and tell which enter, stay and leave
// (paper, "areas of interest"). Keep what a zone means in an array by ZoneId::index.
//
// A frame   Move bodies and zones, then update() once: each proxy in a zone, or that has left it, is in
//           exactly one event of that zone.
// Grid      The grid holds the bodies; zones are not filed in it. Give update() the same grid always, or
//           another one after forgetOccupants(). After a Grid::shiftOrigin(), set() every zone where it is
//           now before the next update(): then its occupants stay.
// Rollback  A copy is a snapshot, occupants included: assign it together with GridSnapshot::restore(), and the
//           next update() tells what it told the first time. Spans that were handed out are void then.
// Threads   update(), add(), set() and remove() need this object for themselves; update() reads the grid, as
//           queries do. All else is const and may be called from any number of threads.
// Failure   Where memory runs out, or a filter throws, nothing has happened: the next update() tells what
//           this one would have told.
// Bad data  A zone whose shape has a NaN or a negative radius holds no proxy. An inverted box means what
//           overlaps() says.
// Misuse    An id of no zone is asserted. An id of other Zones is, too, unless a zone here has the same id.

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

/// A value that names one zone; zero is null. As in a ProxyId, `index` is small and dense.
struct ZoneId {
    std::uint32_t index = 0;
    std::uint32_t generation = 0;

    /// True for ZoneId{}, which names no zone.
    [[nodiscard]] constexpr bool isNull() const noexcept { return generation == 0; }
    friend constexpr auto operator<=>(const ZoneId&, const ZoneId&) = default;
};

/// Which part of a proxy has to be in a zone.
enum class Presence : std::uint8_t {
    position,  ///< its position (position_region.hpp), and of course its box
    box,       ///< any part of its box
};

/// A closed volume. A ConvexRegion made for Containment::inside wants the whole box inside.
template <class Scalar>
struct Zone {
    std::variant<BoxRegion<Scalar>, SphereRegion<Scalar>, ConvexRegion<Scalar>> shape;
    Presence presence = Presence::position;
};

/// A zone and a proxy that entered it, stayed in it or left it. Ordered by zone, then by proxy.
struct ZoneEvent {
    ZoneId zone;
    ProxyId proxy;

    friend constexpr auto operator<=>(const ZoneEvent&, const ZoneEvent&) = default;
};

/// What happened between two updates, each list sorted by zone, then proxy.
struct ZoneEvents {
    std::span<const ZoneEvent> entered;
    std::span<const ZoneEvent> stayed;
    /// Includes removed proxies and zones, by their old ids.
    std::span<const ZoneEvent> left;
};

/// Says whether a proxy counts in a zone. Asked only about proxies in the zone, on all threads. A proxy that
/// it accepted before and refuses now has left the zone.
using ZoneFilter = FunctionRef<bool(ZoneId, ProxyId)>;

/// The filter that accepts every proxy.
[[nodiscard]] inline bool acceptAllInZones(ZoneId /*zone*/, ProxyId /*proxy*/) noexcept {
    return true;
}

/// Says whether an update looks into a zone.
using ZoneChoice = FunctionRef<bool(ZoneId)>;

/// The choice of every zone.
[[nodiscard]] inline bool allZones(ZoneId /*zone*/) noexcept {
    return true;
}

/// Watches zones. Keeps its memory: a frame like the last one allocates nothing.
template <class Scalar>
class HASHPHASE_AI_TEMPLATE_EXPORT Zones {
public:
    // --- Zones -----------------------------------------------------------------------------------

    /// Adds a zone, empty until the next update. Cost: O(1) amortised.
    [[nodiscard]] ZoneId add(const Zone<Scalar>& zone);

    /// Moves, resizes or reshapes a zone; the next update sees it. Cost: O(1).
    void set(ZoneId id, const Zone<Scalar>& zone);

    /// Removes a zone; its id is never valid again. Its occupants leave in the next update. Cost:
    /// O(occupants).
    void remove(ZoneId id);

    [[nodiscard]] bool contains(ZoneId id) const noexcept;
    [[nodiscard]] const Zone<Scalar>& zone(ZoneId id) const;
    [[nodiscard]] std::size_t size() const noexcept { return slots_.size() - freeSlots_.size(); }

    /// Empties all zones without events, before another grid replaces this one.
    void forgetOccupants() noexcept;

    // --- Frame -----------------------------------------------------------------------------------

    /// Finds which proxies are in each zone now, and returns what has changed since the last update. Valid
    /// until the next update. The result does not depend on `parallelFor`. `due` is asked once for each zone.
    /// A zone that it leaves out keeps its occupants, removed ones included, and has no events: the next
    /// update that looks into the zone tells all that has changed since. Cost: a query for each zone that is
    /// due, at most one test for each zone and proxy (Grid::visit()), and the sum of the occupants.
    ZoneEvents update(const Grid<Scalar>& grid, ZoneFilter filter = acceptAllInZones,
                      ZoneChoice due = allZones, ParallelFor parallelFor = serialFor);

    // --- Queries ---------------------------------------------------------------------------------

    /// The proxies in the zone at the last update, sorted by id. Valid until the next update.
    [[nodiscard]] std::span<const ProxyId> occupants(ZoneId id) const;

    /// Finds the zones that hold the point [m] now. Replaces what `found` held; sorted by id. Finds none when
    /// the point is not finite. Cost: O(zones).
    void zonesAt(const Vector3<Scalar>& point, std::vector<ZoneId>& found) const;

    /// What the last update() cost; hits are boxes found, before presence and filter count.
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
