// SPDX-License-Identifier: Zlib
#include <integration/ai/rarest_colour.hpp>

#include <broadphase/diagnostics.hpp>

#include <algorithm>
#include <iterator>

namespace hashphase {

template <class Scalar>
QueryCost RarestColour<Scalar>::update(const Grid<Scalar>& grid, Scalar radius,
                                       std::uint32_t colourCount, std::span<std::uint32_t> colours,
                                       ProxyFilter filter, ParallelFor parallelFor,
                                       ProxyFilter changes) {
    HASHPHASE_ASSERT(colourCount > 0 && colourCount <= Crowd<Scalar>::kMostGroups,
                     "There are 1 to kMostGroups colours.");
    crowd_.take(grid, radius, filter, parallelFor);
    const std::span<const ProxyId> ids = crowd_.ids();
    HASHPHASE_ASSERT(
        std::all_of(ids.begin(), ids.end(), [&](ProxyId id) { return id.index < colours.size(); }),
        "There is a colour for each agent, by ProxyId::index.");

    // All read ...
    counts_.resize(ids.size() * colourCount);
    const auto colourOf = [colours](ProxyId id) { return colours[id.index]; };
    const QueryCost cost = crowd_.countGroups(colourOf, colourCount, counts_, parallelFor);

    // ... then all change.
    constexpr std::size_t kGrain = 4096;
    parallelFor(ids.size(), kGrain, [&](std::size_t begin, std::size_t end) {
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
std::size_t RarestColour<Scalar>::memoryBytes() const noexcept {
    return sizeof(*this) - sizeof(crowd_) + crowd_.memoryBytes() +
           counts_.capacity() * sizeof(std::uint32_t);
}

template class RarestColour<float>;
template class RarestColour<double>;

}  // namespace hashphase
