// SPDX-License-Identifier: Zlib
#include <demos/viewer/session/cell_loads.hpp>

#include <algorithm>
#include <cmath>

namespace hashphase::demos {

void CellLoads::count(const Grid<float>& grid, const Aabb<float>& bounds) {
    const Vector3<float> sizes = bounds.sizes();
    const float extent = std::max(sizes.x(), sizes.z());
    const float finest = grid.cellSize();
    cellSize_ = finest * std::max(1.0F, std::ceil(extent / (finest * (kMostColumns - 2))));
    const auto cellOf = [this](float x) { return std::floor(x / cellSize_); };
    corner_ = cellSize_ * Eigen::Vector2f(cellOf(bounds.min().x()), cellOf(bounds.min().z()));
    // Far from the origin, cells may be smaller than what coordinates are rounded to.
    const auto countTo = [this](float length) {
        const float count = std::max(1.0F, std::floor(length / cellSize_) + 1);
        return static_cast<std::uint32_t>(std::min(count, float{kMostColumns}));
    };
    columns_ = countTo(bounds.max().x() - corner_.x());
    rows_ = countTo(bounds.max().z() - corner_.y());
    counts_.assign(std::size_t{columns_} * rows_, 0);
    largest_ = 0;
    grid.forEach([this](ProxyId, const Aabb<float>& box) {
        const Vector3<float> middle = box.center();
        const float column = (middle.x() - corner_.x()) / cellSize_;
        const float row = (middle.z() - corner_.y()) / cellSize_;
        const bool isInside = column >= 0 && row >= 0 && column < static_cast<float>(columns_) &&
                              row < static_cast<float>(rows_);
        if (isInside) {
            std::uint32_t& load = counts_[std::size_t{static_cast<std::uint32_t>(row)} * columns_ +
                                          static_cast<std::uint32_t>(column)];
            largest_ = std::max(largest_, ++load);
        }
    });
    full_ = std::max(largest_, 8U);
    shades_.resize(counts_.size());
    std::transform(counts_.begin(), counts_.end(), shades_.begin(), [this](std::uint32_t load) {
        return static_cast<std::uint8_t>(load * 255 / full_);
    });
}

std::uint32_t CellLoads::at(float x, float z) const {
    const float column = (x - corner_.x()) / cellSize_;
    const float row = (z - corner_.y()) / cellSize_;
    const bool isInside = column >= 0 && row >= 0 && column < static_cast<float>(columns_) &&
                          row < static_cast<float>(rows_);
    return isInside ? counts_[std::size_t{static_cast<std::uint32_t>(row)} * columns_ +
                              static_cast<std::uint32_t>(column)]
                    : 0;
}

}  // namespace hashphase::demos
