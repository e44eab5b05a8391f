// SPDX-License-Identifier: Zlib
#include <broadphase/neighbours.hpp>

#include <broadphase/core/ensure_capacity.hpp>
#include <broadphase/geometry/padded_box.hpp>
#include <broadphase/geometry/unit_scale.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hashphase {
namespace {

template <class Scalar>
detail::PaddedBox<Scalar> grown(const detail::PaddedBox<Scalar>& box, Scalar by) {
    // Rounded outward, by more than the subtractions of squaredGap() may lose.
    constexpr Scalar epsilon = 4 * std::numeric_limits<Scalar>::epsilon();
    by += std::numeric_limits<Scalar>::min();
    detail::PaddedBox<Scalar> result{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Scalar low = box.low[axis];
        const Scalar high = box.high[axis];
        const Scalar lowBy = by + epsilon * (std::abs(low) + by);
        const Scalar highBy = by + epsilon * (std::abs(high) + by);
        // Not infinity less infinity.
        const bool isEverywhere = std::isinf(by);
        result.low[axis] = isEverywhere ? -by : std::isinf(low) ? low : low - lowBy;
        result.high[axis] = isEverywhere ? by : std::isinf(high) ? high : high + highBy;
    }
    return result;
}

/// The square of how far the boxes are apart, in units of 1 / scale; the same for (b, a).
template <class Scalar>
Scalar squaredGap(const detail::PaddedBox<Scalar>& a, const detail::PaddedBox<Scalar>& b,
                  Scalar scale) {
    Scalar squares[4];
    for (std::size_t axis = 0; axis < 4; ++axis) {  // the fourth is 0, and fills the register
        const Scalar before = a.low[axis] - b.high[axis];
        const Scalar behind = b.low[axis] - a.high[axis];
        // NaN, of two infinities, is none.
        Scalar gap = before > 0 ? before : Scalar(0);
        gap = behind > gap ? behind : gap;
        squares[axis] = (gap * scale) * (gap * scale);
    }
    return (squares[0] + squares[1]) + (squares[2] + squares[3]);
}

}  // namespace

template <class Scalar>
std::span<const ProxyPair> Neighbours<Scalar>::find(const Grid<Scalar>& grid, Scalar distance,
                                                    ParallelFor parallelFor) & {
    const std::size_t lastCount = std::max(ids_.size(), candidates_.size());
    if (peaks_.isPast(lastCount, std::max(ids_.capacity(), found_.capacity()))) {
        releaseMemory();
    }
    ids_.clear();
    boxes_.clear();
    grown_.clear();
    cost_ = {};
    if (!(distance >= 0)) {
        return {};
    }
    grid.store().forEachFiled([this](ProxyId id, const Aabb<Scalar>& box) {
        ids_.push_back(id);
        boxes_.push_back(detail::padded(box));
    });
    for (auto i = static_cast<std::uint32_t>(proxyIndices_.size()); i < ids_.size(); ++i) {
        proxyIndices_.push_back(i);
    }
    proxyIndices_.resize(ids_.size());
    grown_.resize(boxes_.size());
    constexpr std::size_t grain = 4096;
    parallelFor(boxes_.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            grown_[i] = grown(boxes_[i], distance / 2);
        }
    });
    table_.build(proxyIndices_, grown_, {}, parallelFor);
    detail::KernelCost cost;
    candidates_.clear();
    detail::joinTable(table_, parallelFor, parts_, candidates_, cost);
    const Scalar scale = detail::unitScale(distance);
    const Scalar reach = (distance * scale) * (distance * scale);
    const auto order = table_.order();
    found_.resize(std::max(found_.size(), candidates_.size()));
    ProxyPair* next = found_.data();
    for (const auto [a, b] : candidates_.pairs()) {
        // Written at any rate, and counted where it is one: neither that nor the order of ids can
        // be predicted.
        const std::array<ProxyId, 2> ids{ids_[order[a]], ids_[order[b]]};
        const std::size_t lower = ids[0].index < ids[1].index ? 0 : 1;
        *next = {ids[lower], ids[1 - lower]};
        next += squaredGap(boxes_[order[a]], boxes_[order[b]], scale) <= reach ? 1 : 0;
    }
    const auto count = static_cast<std::size_t>(next - found_.data());
    cost_ = {cost.rowsVisited, cost.boxesTested, count};
    return std::span(found_).first(count);
}

template <class Scalar>
std::size_t Neighbours<Scalar>::memoryBytes() const noexcept {
    return sizeof(*this) + proxyIndices_.capacity() * sizeof(proxyIndices_[0]) +
           ids_.capacity() * sizeof(ProxyId) +
           (boxes_.capacity() + grown_.capacity()) * sizeof(boxes_[0]) + table_.memoryBytes() +
           parts_.memoryBytes() + candidates_.memoryBytes() + found_.capacity() * sizeof(ProxyPair);
}

template <class Scalar>
void Neighbours<Scalar>::releaseMemory() noexcept {
    detail::freeArrays(ids_, boxes_, grown_, proxyIndices_, found_);
    table_ = {};
    parts_ = {};
    candidates_ = {};
}

template class HASHPHASE_INSTANCE_EXPORT Neighbours<float>;
template class HASHPHASE_INSTANCE_EXPORT Neighbours<double>;

}  // namespace hashphase
