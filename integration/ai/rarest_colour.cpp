// SPDX-License-Identifier: Zlib
#include <integration/ai/rarest_colour.hpp>

#include <broadphase/core/query_scope.hpp>
#include <broadphase/core/shared_cost.hpp>
#include <broadphase/diagnostics.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/position_region.hpp>

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <utility>

namespace hashphase {
namespace {

constexpr std::size_t kAtOnce = 16;

[[maybe_unused]] constexpr const char* kIsUpdating =
    "RarestColour was updated from within its own filter or changes. Update it after that update "
    "returns.";

/// Counts the colours of those who are near one agent.
struct ColourCount {
    ProxyId agent;
    const ProxyFilter* filter = nullptr;
    std::span<const std::uint32_t> colours;
    std::uint32_t colourCount = 0;
    std::array<std::uint32_t, RadiusSearch<float>::kMostGroups> counts{};

    template <class Scalar>
    void add(ProxyId id, Scalar /*key*/) {
        const std::uint32_t colour = colours[id.index];
        if (id != agent && colour < colourCount && (*filter)(id)) {
            ++counts[colour];
        }
    }
    [[nodiscard]] static constexpr double limit() noexcept {
        return std::numeric_limits<double>::infinity();
    }
};

/// What `regionOf` gives for each of the numbers.
template <class RegionOf, std::size_t... numbers>
auto regionsOf(const RegionOf& regionOf, std::index_sequence<numbers...>) {
    return std::array{regionOf(numbers)...};
}

/// The rarest colour around each of 1 to kAtOnce agents; colourCount for who is nowhere.
template <class Scalar>
QueryCost countAround(const Grid<Scalar>& grid, Scalar radius, std::uint32_t colourCount,
                      std::span<const std::uint32_t> colours, std::span<const ProxyId> agents,
                      const ProxyFilter& filter, std::span<std::uint32_t> rarest) {
    const auto regionOf = [&](std::size_t i) {
        const ProxyId agent = agents[std::min(i, agents.size() - 1)];
        return PositionRegion<Scalar>(positionOf(grid.box(agent)), radius);
    };
    const auto around = regionsOf(regionOf, std::make_index_sequence<kAtOnce>());
    std::array<ColourCount, kAtOnce> found;
    for (std::size_t i = 0; i < agents.size(); ++i) {
        found[i] = {agents[i], &filter, colours, colourCount, {}};
    }
    const QueryCost cost = grid.visitEach(std::span(around).first(agents.size()),
                                          std::span(found).first(agents.size()));
    for (std::size_t i = 0; i < agents.size(); ++i) {
        const auto* const counts = found[i].counts.data();
        const bool isSomewhere = around[i].center().allFinite();
        rarest[i] = isSomewhere ? static_cast<std::uint32_t>(
                                      std::min_element(counts, counts + colourCount) - counts)
                                : colourCount;
    }
    return cost;
}

}  // namespace

// The search tells its own scopes, so there may be none of this object's around its calls.
template <class Scalar>
bool RarestColour<Scalar>::isUpdating() const noexcept {
    return detail::QueryScope::isWithin(this) || detail::QueryScope::isWithin(&search_);
}

template <class Scalar>
QueryCost RarestColour<Scalar>::update(const Grid<Scalar>& grid, Scalar radius,
                                       std::uint32_t colourCount, std::span<std::uint32_t> colours,
                                       ProxyFilter filter, ProxyFilter changes,
                                       ParallelFor parallelFor) {
    HASHPHASE_ASSERT(!isUpdating(), kIsUpdating);
    if (isUpdating()) {
        return {};
    }
    HASHPHASE_ASSERT(colourCount > 0 && colourCount <= RadiusSearch<Scalar>::kMostGroups,
                     "RarestColour::update(): colourCount is 0 or too large. Pass 1 to "
                     "RadiusSearch::kMostGroups.");
    search_.take(grid, radius, filter, parallelFor);
    const std::span<const ProxyId> ids = search_.ids();
    HASHPHASE_ASSERT(
        std::all_of(ids.begin(), ids.end(), [&](ProxyId id) { return id.index < colours.size(); }),
        "RarestColour::update(): colours is too short. Pass one for each ProxyId::index: "
        "Grid::indexLimit() of them.");

    // All read ...
    counts_.resize(ids.size() * colourCount);
    const auto colourOf = [colours](ProxyId id) { return colours[id.index]; };
    const QueryCost cost = search_.countGroups(colourCount, colourOf, counts_, parallelFor);

    // ... then all change.
    constexpr std::size_t kGrain = 4096;
    parallelFor(ids.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        const detail::QueryScope scope(this);
        for (std::size_t agent = begin; agent < end; ++agent) {
            if (!changes(ids[agent])) {
                continue;
            }
            const std::uint32_t* counts = counts_.data() + agent * colourCount;
            const std::uint32_t* rarest = std::min_element(counts, counts + colourCount);
            colours[ids[agent].index] = static_cast<std::uint32_t>(rarest - counts);
        }
    });
    return cost;
}

template <class Scalar>
QueryCost RarestColour<Scalar>::updateSome(const Grid<Scalar>& grid, Scalar radius,
                                           std::uint32_t colourCount,
                                           std::span<std::uint32_t> colours,
                                           std::span<const ProxyId> agents, ProxyFilter filter,
                                           ParallelFor parallelFor) {
    HASHPHASE_ASSERT(!isUpdating(), kIsUpdating);
    if (isUpdating()) {
        return {};
    }
    HASHPHASE_ASSERT(colourCount > 0 && colourCount <= RadiusSearch<Scalar>::kMostGroups,
                     "RarestColour::updateSome(): colourCount is 0 or too large. Pass 1 to "
                     "RadiusSearch::kMostGroups.");
    HASHPHASE_ASSERT(grid.indexLimit() <= colours.size(),
                     "RarestColour::updateSome(): colours is too short. Pass one for each "
                     "ProxyId::index: Grid::indexLimit() of them.");
    // All read ...
    rarest_.resize(agents.size());
    constexpr std::size_t kGrain = 64;
    detail::SharedCost sum;
    parallelFor(agents.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        const detail::QueryScope scope(this);
        QueryCost cost;
        for (std::size_t first = begin; first < end; first += kAtOnce) {
            const std::size_t count = std::min(kAtOnce, end - first);
            cost += countAround<Scalar>(grid, radius, colourCount, colours,
                                        agents.subspan(first, count), filter,
                                        std::span(rarest_).subspan(first, count));
        }
        sum.add(cost);
    });
    // ... then all change.
    for (std::size_t i = 0; i < agents.size(); ++i) {
        if (rarest_[i] < colourCount) {
            colours[agents[i].index] = rarest_[i];
        }
    }
    return sum.sum();
}

template <class Scalar>
std::size_t RarestColour<Scalar>::memoryBytes() const noexcept {
    return sizeof(*this) - sizeof(search_) + search_.memoryBytes() +
           (counts_.capacity() + rarest_.capacity()) * sizeof(std::uint32_t);
}

template class HASHPHASE_INSTANCE_EXPORT RarestColour<float>;
template class HASHPHASE_INSTANCE_EXPORT RarestColour<double>;

}  // namespace hashphase
