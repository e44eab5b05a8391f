// SPDX-License-Identifier: Zlib
#include <integration/ai/radar.hpp>

#include <broadphase/core/query_scope.hpp>
#include <broadphase/diagnostics.hpp>
#include <broadphase/position_region.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hashphase {
namespace {

/// The window's cells. A box overlaps bounds() when its position is in one of them.
template <class Scalar>
class RadarCells {
public:
    explicit RadarCells(const RadarWindow<Scalar>& window)
        : counts_{window.columns, window.rows, window.layers == 0 ? 1 : window.layers},
          isFlat_(window.layers == 0),
          size_(window.cellSize),
          isTurned_(window.heading.has_value()) {
        const Scalar heading = window.heading.value_or(0);
        if (!(size_ > 0 && std::isfinite(size_) && std::isfinite(heading) &&
              window.center.allFinite())) {
            size_ = std::numeric_limits<Scalar>::quiet_NaN();
        }
        const std::array<int, 2> across = mapAxes(window.up);
        axes_ = {across[0], across[1], static_cast<int>(window.up)};
        cosine_ = std::cos(heading);
        sine_ = std::sin(heading);
        for (std::size_t i = 0; i < 3; ++i) {
            center_[i] = window.center[axes_[i]];
            const auto before = counts_[i] / 2;
            first_[i] = isTurned_ ? Scalar(0)
                                  : std::floor(center_[i] / size_) - static_cast<Scalar>(before);
        }
    }

    [[nodiscard]] std::size_t size() const noexcept {
        return std::size_t{counts_[0]} * counts_[1] * counts_[2];
    }

    /// The place of the position's cell in [layer][row][column]; size() outside. NaN is outside.
    [[nodiscard]] std::size_t cellOf(const Vector3<Scalar>& position) const noexcept {
        std::array<Scalar, 3> along{position[axes_[0]], position[axes_[1]], position[axes_[2]]};
        if (isTurned_) {
            const Scalar x = along[0] - center_[0];
            const Scalar z = along[1] - center_[1];
            along = {cosine_ * x - sine_ * z, sine_ * x + cosine_ * z, along[2] - center_[2]};
        }
        std::array<std::size_t, 3> cell{};
        for (std::size_t i = 0; i < 3; ++i) {
            const Scalar steps = along[i] / size_ + (isTurned_ ? half(i) : Scalar(0));
            const Scalar index = std::floor(steps) - first_[i];
            const bool isAnywhere = i == 2 && isFlat_ && along[i] == along[i] && size_ == size_;
            if (isAnywhere) {
                continue;
            }
            if (!(index >= 0 && index < static_cast<Scalar>(counts_[i]))) {
                return size();
            }
            cell[i] = static_cast<std::size_t>(index);
        }
        return (cell[2] * counts_[1] + cell[1]) * counts_[0] + cell[0];
    }

    /// Rounded outward.
    [[nodiscard]] Aabb<Scalar> bounds() const noexcept {
        using Limits = std::numeric_limits<Scalar>;
        Aabb<Scalar> bounds;
        for (std::size_t i = 0; i < 3; ++i) {
            Scalar low = first_[i] * size_;
            Scalar high = (first_[i] + static_cast<Scalar>(counts_[i])) * size_;
            if (isTurned_) {
                const Scalar across = i == 0 ? half(1) : half(0);
                const Scalar reach =
                    i == 2 ? half(2) : std::abs(cosine_) * half(i) + std::abs(sine_) * across;
                low = center_[i] - reach * size_;
                high = center_[i] + reach * size_;
            }
            const Scalar sizes = std::abs(low) + std::abs(high) + std::abs(center_[i]) + size_;
            const Scalar margin = 16 * Limits::epsilon() * sizes + Limits::min();
            const bool isAnywhere = i == 2 && isFlat_;
            bounds.min()[axes_[i]] = isAnywhere ? -Limits::infinity() : low - margin;
            bounds.max()[axes_[i]] = isAnywhere ? Limits::infinity() : high + margin;
        }
        return bounds;
    }

private:
    [[nodiscard]] Scalar half(std::size_t i) const noexcept {
        return static_cast<Scalar>(counts_[i]) / 2;
    }

    std::array<std::uint32_t, 3> counts_;  // all of these: by column, row and layer
    std::array<int, 3> axes_{};
    std::array<Scalar, 3> center_{};
    std::array<Scalar, 3> first_{};  // the first cell's number in the world
    bool isFlat_;
    Scalar size_;
    bool isTurned_;
    Scalar cosine_ = 1;
    Scalar sine_ = 0;
};

template <class Scalar>
struct CollectRadar {
    const Grid<Scalar>& grid;
    const RadarCells<Scalar>& cells;
    std::uint32_t groupCount;
    RadarGroups groupOf;
    std::span<std::uint32_t> counts;

    void add(ProxyId id, Scalar /*key*/) {
        const std::size_t cell = cells.cellOf(positionOf(grid.box(id)));
        if (cell == cells.size()) {
            return;
        }
        if (const std::uint32_t group = groupOf(id); group < groupCount) {
            ++counts[group * cells.size() + cell];
        }
    }
    [[nodiscard]] static constexpr Scalar limit() noexcept {
        return std::numeric_limits<Scalar>::infinity();
    }
};

}  // namespace

template <class Scalar>
std::span<const std::uint32_t> Radar<Scalar>::scan(const Grid<Scalar>& grid,
                                                   const RadarWindow<Scalar>& window,
                                                   std::uint32_t groupCount,
                                                   RadarGroups groupOf) & {
    HASHPHASE_ASSERT(
        !detail::QueryScope::isWithin(this),
        "Radar::scan() was called from within its own scan. Call it after that returns.");
    const detail::QueryScope scope(this);
    const RadarCells<Scalar> cells(window);
    HASHPHASE_ASSERT(
        double{1} * window.columns * window.rows * std::max(window.layers, 1U) * groupCount <=
            double{kMostCounts},
        "Radar::scan(): the window has more than 2^28 counts. Use fewer columns, rows, layers or "
        "groups.");
    counts_.assign(groupCount * cells.size(), 0);
    CollectRadar<Scalar> collector{grid, cells, groupCount, groupOf, counts_};
    cost_ =
        counts_.empty() ? QueryCost{} : grid.visit(BoxRegion<Scalar>{cells.bounds()}, collector);
    return counts_;
}

template class HASHPHASE_INSTANCE_EXPORT Radar<float>;
template class HASHPHASE_INSTANCE_EXPORT Radar<double>;

}  // namespace hashphase
