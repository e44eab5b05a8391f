// SPDX-License-Identifier: Zlib
#pragma once

// How crowded a population is, on every scale: which share of it stands in a proxy's own cell, for
// cells of any size. Measured on a sample, as the probability that two of it share a cell (the
// correlation sum of Grassberger and Procaccia, "Measuring the strangeness of strange attractors",
// 1983): piles that stand far apart are as crowded as one pile is, whatever lies between.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace hashphase::detail {

/// A set of axes: bit i for axis i. Rows run along x, which is never flat.
using AxisSet = std::uint8_t;

class DensityEstimate {
public:
    /// Takes points [m] of a population most of which lies between low and high. Those far outside
    /// share no cell with anything. Cost: a few sorts of the points.
    void measure(std::span<const std::array<double, 3>> points, const std::array<double, 3>& low,
                 const std::array<double, 3>& high);

    /// The mean share of the population, 0 to 1, in the cell of one of its points, for cells of
    /// `size` [m] that reach from end to end along the flat axes.
    [[nodiscard]] double shareInCell(double size, AxisSet flat) const;

    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return keys_.capacity() * sizeof(std::uint64_t);
    }

private:
    static constexpr std::size_t kScales = 21;

    /// Binary logarithms of the share in cells of edge_ / 2^i; counted up to `last`, and falling by
    /// `slope` a scale beyond.
    struct Shares {
        std::array<double, kScales> log{};
        std::size_t last = 0;
        double slope = 0;
    };

    [[nodiscard]] Shares count(std::size_t pointCount);

    double edge_ = 0;                  // [m] of the cell that holds all
    std::array<Shares, 4> shares_{};   // by flat axes, without x
    std::vector<std::uint64_t> keys_;  // scratch
};

}  // namespace hashphase::detail
