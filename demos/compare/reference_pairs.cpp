// SPDX-License-Identifier: Zlib
#include <demos/compare/reference_pairs.hpp>

#include <algorithm>
#include <array>

namespace hashphase::demos {
namespace {

bool touch(const Aabb<float>& a, const Aabb<float>& b) {
    return (a.min().array() <= b.max().array()).all() && (b.min().array() <= a.max().array()).all();
}

bool allowed(std::span<const CollisionFilter> filters, std::uint32_t a, std::uint32_t b) {
    return filters.empty() || mayPair(filters[a], filters[b]);
}

void findByBruteForce(std::span<const Aabb<float>> boxes, std::span<const CollisionFilter> filters,
                      std::vector<PairKey>& pairs) {
    const auto count = static_cast<std::uint32_t>(boxes.size());
    for (std::uint32_t a = 0; a < count; ++a) {
        for (std::uint32_t b = a + 1; b < count; ++b) {
            if (touch(boxes[a], boxes[b]) && allowed(filters, a, b)) {
                pairs.push_back(pairKey(a, b));
            }
        }
    }
}

// The axis along which the boxes lie farthest apart. Boxes without end say nothing about that.
Eigen::Index widestAxis(std::span<const Aabb<float>> boxes) {
    constexpr float kWithoutEnd = 1e15F;
    Eigen::Array3d sum = Eigen::Array3d::Zero();
    Eigen::Array3d squares = Eigen::Array3d::Zero();
    double count = 0;
    for (const Aabb<float>& box : boxes) {
        if ((box.min().array().abs() < kWithoutEnd).all()) {
            const Eigen::Array3d place = box.min().cast<double>().array();
            sum += place;
            squares += place * place;
            ++count;
        }
    }
    Eigen::Index axis = 0;
    if (count > 0) {
        (squares / count - (sum / count).square()).maxCoeff(&axis);
    }
    return axis;
}

// The boxes in order of their lower ends on the sweep axis, one array a coordinate: first the sweep
// axis, then the two others.
struct SweepOrder {
    std::vector<std::uint32_t> object;
    std::array<std::vector<float>, 3> low;
    std::array<std::vector<float>, 3> high;
};

SweepOrder sortAlong(Eigen::Index axis, std::span<const Aabb<float>> boxes) {
    SweepOrder order;
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        // NaN overlaps nothing, and would upset the sort.
        if (!boxes[i].min().hasNaN() && !boxes[i].max().hasNaN()) {
            order.object.push_back(i);
        }
    }
    std::sort(order.object.begin(), order.object.end(),
              [axis, boxes](std::uint32_t a, std::uint32_t b) {
                  return boxes[a].min()[axis] < boxes[b].min()[axis];
              });
    for (std::size_t k = 0; k < 3; ++k) {
        const Eigen::Index source = (axis + static_cast<Eigen::Index>(k)) % 3;
        order.low[k].reserve(order.object.size());
        order.high[k].reserve(order.object.size());
        for (const std::uint32_t i : order.object) {
            order.low[k].push_back(boxes[i].min()[source]);
            order.high[k].push_back(boxes[i].max()[source]);
        }
    }
    return order;
}

void findBySweep(std::span<const Aabb<float>> boxes, std::span<const CollisionFilter> filters,
                 std::vector<PairKey>& pairs) {
    const SweepOrder order = sortAlong(widestAxis(boxes), boxes);
    const auto& low = order.low;
    const auto& high = order.high;
    std::vector<std::uint32_t> hits(order.object.size());
    for (std::size_t i = 0; i < order.object.size(); ++i) {
        const auto end = std::upper_bound(low[0].begin() + static_cast<std::ptrdiff_t>(i) + 1,
                                          low[0].end(), high[0][i]);
        const auto last = static_cast<std::size_t>(end - low[0].begin());
        // Written without branches: whether a candidate overlaps cannot be predicted.
        const auto isOrdered = [](auto a, auto b) { return a <= b ? 1U : 0U; };
        std::size_t hitCount = 0;
        for (std::size_t j = i + 1; j < last; ++j) {
            hits[hitCount] = static_cast<std::uint32_t>(j);
            hitCount += isOrdered(low[0][i], high[0][j]) & isOrdered(low[1][j], high[1][i]) &
                        isOrdered(low[1][i], high[1][j]) & isOrdered(low[2][j], high[2][i]) &
                        isOrdered(low[2][i], high[2][j]);
        }
        for (std::size_t hit = 0; hit < hitCount; ++hit) {
            const std::uint32_t a = order.object[i];
            const std::uint32_t b = order.object[hits[hit]];
            if (allowed(filters, a, b)) {
                pairs.push_back(pairKey(a, b));
            }
        }
    }
    std::sort(pairs.begin(), pairs.end());
}

}  // namespace

void findExactPairs(ReferenceMethod method, std::span<const Aabb<float>> boxes,
                    std::span<const CollisionFilter> filters, std::vector<PairKey>& pairs) {
    pairs.clear();
    if (method == ReferenceMethod::kBrute) {
        findByBruteForce(boxes, filters, pairs);
    } else {
        findBySweep(boxes, filters, pairs);
    }
}

}  // namespace hashphase::demos
