// SPDX-License-Identifier: Zlib
#include <integration/ai/zones.hpp>

#include <broadphase/collectors.hpp>
#include <broadphase/core/ensure_capacity.hpp>
#include <broadphase/core/limits.hpp>
#include <broadphase/core/query_scope.hpp>
#include <broadphase/diagnostics.hpp>
#include <broadphase/proxy_filter.hpp>

#include <algorithm>
#include <type_traits>

namespace hashphase {
namespace {

[[maybe_unused]] constexpr const char* kMustNotChange =
    "Zones were changed or updated from within the filter of update(). Do so after update() "
    "returns.";

template <class Scalar, class Region>
bool isIn(const Region& region, const Vector3<Scalar>& point) {
    return region.key(Aabb<Scalar>(point, point)) >= 0;
}

template <class Scalar, class Region>
QueryCost findOccupants(const Grid<Scalar>& grid, const Region& region, Presence presence,
                        ProxyFilter filter, std::vector<ProxyId>& occupants) {
    occupants.clear();
    CollectAll all(occupants);
    // By their boxes first: one that contains a position of the zone touches the zone.
    const auto isPresent = [&](ProxyId id) {
        return (presence == Presence::box || isIn<Scalar>(region, positionOf(grid.box(id)))) &&
               filter(id);
    };
    CollectIf present(all, isPresent);
    const QueryCost cost = grid.visit(region, present);
    std::sort(occupants.begin(), occupants.end());
    return cost;
}

}  // namespace

// --- Zones ---------------------------------------------------------------------------------------

template <class Scalar>
ZoneId Zones<Scalar>::add(const Zone<Scalar>& zone) {
    HASHPHASE_ASSERT(!detail::QueryScope::isWithin(this), kMustNotChange);
    auto index = static_cast<std::uint32_t>(slots_.size());
    if (freeSlots_.empty()) {
        detail::ensureCapacity(freeSlots_, slots_.size() + 1);  // so that remove() has room
        static_assert(std::is_nothrow_move_constructible_v<Slot>, "else occupants() would dangle");
        slots_.emplace_back(zone);
    } else {
        index = freeSlots_.back();
        slots_[index].zone = zone;
        freeSlots_.pop_back();
    }
    return {index, ++slots_[index].generation};
}

template <class Scalar>
void Zones<Scalar>::set(ZoneId id, const Zone<Scalar>& zone) {
    HASHPHASE_ASSERT(contains(id),
                     "Zones::set(): the id is null, stale, or of other Zones. Pass an id that "
                     "add() returned and that was not removed.");
    HASHPHASE_ASSERT(!detail::QueryScope::isWithin(this), kMustNotChange);
    if (contains(id)) {
        slots_[id.index].zone = zone;
    }
}

template <class Scalar>
void Zones<Scalar>::remove(ZoneId id) {
    HASHPHASE_ASSERT(contains(id),
                     "Zones::remove(): the id is null, stale, or of other Zones. Pass an id that "
                     "add() returned and that was not removed.");
    HASHPHASE_ASSERT(!detail::QueryScope::isWithin(this), kMustNotChange);
    if (!contains(id)) {
        return;
    }
    Slot& slot = slots_[id.index];
    detail::ensureCapacity(abandoned_, abandoned_.size() + slot.occupants.size());
    detail::ensureCapacity(freeSlots_, freeSlots_.size() + 1);  // which a copy lacks
    for (const ProxyId proxy : slot.occupants) {
        abandoned_.push_back({id, proxy});
    }
    slot.occupants.clear();
    ++slot.generation;
    if (slot.generation != detail::kLastGeneration) {  // else an id would name two zones
        freeSlots_.push_back(id.index);
    }
}

template <class Scalar>
void Zones<Scalar>::forgetOccupants() noexcept {
    HASHPHASE_ASSERT(!detail::QueryScope::isWithin(this), kMustNotChange);
    for (Slot& slot : slots_) {
        slot.occupants.clear();
    }
    abandoned_.clear();
}

template <class Scalar>
bool Zones<Scalar>::contains(ZoneId id) const noexcept {
    return id.index < slots_.size() && slots_[id.index].generation == id.generation &&
           isAlive(slots_[id.index]);
}

template <class Scalar>
const typename Zones<Scalar>::Slot& Zones<Scalar>::slot(ZoneId id) const {
    HASHPHASE_ASSERT(contains(id),
                     "Zones: the id is null, stale, or of other Zones. Pass an id that add() "
                     "returned and that was not removed.");
    static const Slot none{};
    return contains(id) ? slots_[id.index] : none;
}

template <class Scalar>
const Zone<Scalar>& Zones<Scalar>::zone(ZoneId id) const {
    return slot(id).zone;
}

// --- Frame ---------------------------------------------------------------------------------------

// Who is where now, in the zones that are due.
template <class Scalar>
void Zones<Scalar>::findAll(const Grid<Scalar>& grid, ZoneFilter filter, ZoneChoice due,
                            ParallelFor parallelFor) {
    constexpr std::size_t grain = 8;
    grid.expectQueries(slots_.size());
    parallelFor(slots_.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const detail::QueryScope scope(this);
            Slot& slot = slots_[i];
            const ZoneId id{static_cast<std::uint32_t>(i), slot.generation};
            slot.isDue = isAlive(slot) && due(id);
            if (!slot.isDue) {
                continue;
            }
            const auto counts = [&](ProxyId proxy) { return filter(id, proxy); };
            slot.cost = std::visit(
                [&](const auto& region) {
                    return findOccupants(grid, region, slot.zone.presence, counts, slot.found);
                },
                slot.zone.shape);
        }
    });
}

template <class Scalar>
ZoneEvents Zones<Scalar>::update(const Grid<Scalar>& grid, ZoneFilter filter, ZoneChoice due,
                                 ParallelFor parallelFor) {
    HASHPHASE_ASSERT(!detail::QueryScope::isWithin(this), kMustNotChange);
    findAll(grid, filter, due, parallelFor);
    // What has changed, in the order of zones.
    entered_.clear();
    stayed_.clear();
    left_.clear();
    cost_ = {};
    for (std::size_t i = 0; i < slots_.size(); ++i) {
        if (slots_[i].isDue) {
            tellApart({static_cast<std::uint32_t>(i), slots_[i].generation}, slots_[i]);
            cost_ += slots_[i].cost;
        }
    }
    if (!abandoned_.empty()) {
        left_.insert(left_.end(), abandoned_.begin(), abandoned_.end());
        std::sort(left_.begin(), left_.end());
        abandoned_.clear();
    }
    for (Slot& slot : slots_) {
        if (slot.isDue) {
            slot.occupants.swap(slot.found);
        }
    }
    return {entered_, stayed_, left_};
}

// Merges who was there and who is.
template <class Scalar>
void Zones<Scalar>::tellApart(ZoneId id, const Slot& slot) {
    auto before = slot.occupants.begin();
    auto now = slot.found.begin();
    while (before != slot.occupants.end() || now != slot.found.end()) {
        if (now == slot.found.end() || (before != slot.occupants.end() && *before < *now)) {
            left_.push_back({id, *before++});
        } else if (before == slot.occupants.end() || *now < *before) {
            entered_.push_back({id, *now++});
        } else {
            stayed_.push_back({id, *now++});
            ++before;
        }
    }
}

template <class Scalar>
std::size_t Zones<Scalar>::memoryBytes() const noexcept {
    std::size_t bytes =
        sizeof(*this) + slots_.capacity() * sizeof(Slot) +
        freeSlots_.capacity() * sizeof(std::uint32_t) +
        (entered_.capacity() + stayed_.capacity() + left_.capacity() + abandoned_.capacity()) *
            sizeof(ZoneEvent);
    for (const Slot& slot : slots_) {
        bytes += (slot.occupants.capacity() + slot.found.capacity()) * sizeof(ProxyId);
    }
    return bytes;
}

// --- Queries -------------------------------------------------------------------------------------

template <class Scalar>
std::span<const ProxyId> Zones<Scalar>::occupants(ZoneId id) const {
    return slot(id).occupants;
}

template <class Scalar>
void Zones<Scalar>::zonesAt(const Vector3<Scalar>& point, std::vector<ZoneId>& found) const {
    found.clear();
    for (std::size_t i = 0; i < slots_.size() && point.allFinite(); ++i) {
        const Slot& slot = slots_[i];
        if (isAlive(slot) &&
            std::visit([&](const auto& region) { return isIn<Scalar>(region, point); },
                       slot.zone.shape)) {
            found.push_back({static_cast<std::uint32_t>(i), slot.generation});
        }
    }
}

template class HASHPHASE_INSTANCE_EXPORT Zones<float>;
template class HASHPHASE_INSTANCE_EXPORT Zones<double>;

}  // namespace hashphase
