// SPDX-License-Identifier: Zlib

// Sorting along a space-filling curve and taking neighbours together from the bottom up follows
// Lauterbach et al., "Fast BVH construction on GPUs", 2009, with eight children a node.

#include <broadphase/tree/box_tree.hpp>

#include <broadphase/core/ensure_capacity.hpp>
#include <broadphase/tree/hilbert.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace hashphase::detail {
namespace {

constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();

// Rounds x [m] downward into single precision, by a few units of the last place too many.
float roundedDown(double x) {
    constexpr double most = std::numeric_limits<float>::max();
    const auto rounded = static_cast<float>(std::clamp(x, -most, most));
    return rounded - (std::abs(rounded) * 2 * std::numeric_limits<float>::epsilon() +
                      std::numeric_limits<float>::min());
}

TreeNode8 emptyBlock() {
    TreeNode8 block{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::fill_n(block.bounds[axis], kBlockWidth, kFloatInfinity);
        std::fill_n(block.bounds[axis + 3], kBlockWidth, -kFloatInfinity);
    }
    return block;
}

}  // namespace

template <class Scalar>
void BoxTree::build(const Table<Scalar>& table, typename Table<Scalar>::BoxOfEntry filedBox) {
    levels_.clear();
    blocks_.clear();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        origin_[axis] =
            table.levels().empty() ? 0 : static_cast<double>(table.levels().front().origin[axis]);
    }
    for (const Level<Scalar>& level : table.levels()) {
        readBoxes(table, level, filedBox);
        if (!boxes_.empty()) {
            sortAlongCurve();
            buildLevel();
        }
    }
}

template void BoxTree::build(const Table<float>&, Table<float>::BoxOfEntry);
template void BoxTree::build(const Table<double>&, Table<double>::BoxOfEntry);

template <class Scalar>
void BoxTree::readBoxes(const Table<Scalar>& table, const Level<Scalar>& level,
                        typename Table<Scalar>::BoxOfEntry filedBox) {
    boxes_.clear();
    boxes_.reserve(level.count());
    for (std::uint32_t entry = level.firstEntry; entry < level.lastEntry; ++entry) {
        const Aabb<Scalar> filed = filedBox(entry);
        Box box{};
        bool isNan = hasNan(table.box(entry));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto at = static_cast<Eigen::Index>(axis);
            const double a = static_cast<double>(filed.min()[at]) - origin_[axis];
            const double b = static_cast<double>(filed.max()[at]) - origin_[axis];
            isNan |= a != a || b != b;
            // Bullet's slab test hits inverted boxes, too, within the box the right way round.
            box.low[axis] = roundedDown(std::min(a, b));
            box.high[axis] = -roundedDown(-std::max(a, b));
        }
        if (!isNan) {
            box.children = table.proxyIndex(entry);
            boxes_.push_back(box);
        }
    }
}

// Half the edge of a usual box [m]: steps of the curve in which several boxes seldom begin.
float BoxTree::curveStep() {
    constexpr std::size_t most = 64;
    std::array<float, most> sizes{};
    const std::size_t stride = (boxes_.size() + most - 1) / most;
    std::size_t count = 0;
    for (std::size_t i = 0; i < boxes_.size(); i += stride) {
        sizes[count++] = boxes_[i].longestEdge();
    }
    const std::size_t middle = count / 2;
    std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(middle),
                     sizes.begin() + static_cast<std::ptrdiff_t>(count));
    return sizes[middle] / 2;
}

// In the order of their lowest corners.
void BoxTree::sortAlongCurve() {
    // Of an extent of twice as much, the inverse is no denormal number, which might be flushed to 0.
    constexpr float limit = std::numeric_limits<float>::max() / 16;
    std::array<float, 3> lowest{limit, limit, limit};
    float extent = std::numeric_limits<float>::min();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        float highest = -limit;
        for (const Box& box : boxes_) {
            lowest[axis] = std::min(lowest[axis], box.low[axis]);
            highest = std::max(highest, box.low[axis]);
        }
        // What is farther away shares the first or the last step.
        lowest[axis] = std::max(lowest[axis], -limit);
        extent = std::max(extent, std::min(highest, limit) - lowest[axis]);
    }
    constexpr auto most = static_cast<float>((1 << kHilbertBits) - 1);
    const float steps = std::clamp(extent / curveStep(), 1.0F, most);
    const float perMetre = std::min(steps / extent, 1 / std::numeric_limits<float>::min());
    const auto bits = static_cast<int>(std::bit_width(static_cast<std::uint32_t>(steps)));
    places_.resize(boxes_.size());
    for (std::uint32_t i = 0; i < boxes_.size(); ++i) {
        std::array<std::uint32_t, 3> point{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float low = std::min(boxes_[i].low[axis], limit);
            const float step = (low - lowest[axis]) * perMetre;
            point[axis] = static_cast<std::uint32_t>(std::clamp(step, 0.0F, steps));
        }
        places_[i] = {placeOnHilbertCurve(point, bits), i};
    }
    sortPlaces(3 * bits);
    unsorted_.swap(boxes_);
    boxes_.resize(places_.size());
    for (std::size_t i = 0; i < places_.size(); ++i) {
        boxes_[i] = unsorted_[places_[i].box];
    }
}

// A radix sort of the lowest bits: stable, so that equal places keep the table's order.
void BoxTree::sortPlaces(int bits) {
    constexpr int kMostDigitBits = 11;
    const int passes = (bits + kMostDigitBits - 1) / kMostDigitBits;
    const int digitBits = (bits + passes - 1) / passes;  // NOLINT(*DivideZero): bits is positive
    std::array<std::uint32_t, (1U << kMostDigitBits) + 1> starts;
    places2_.resize(places_.size());
    for (int pass = 0; pass < passes; ++pass) {
        const int shift = pass * digitBits;
        const std::uint32_t digits = (1U << digitBits) - 1;
        const auto digitOf = [=](const Place& place) {
            return static_cast<std::uint32_t>(place.onCurve >> shift) & digits;
        };
        starts.fill(0);
        for (const Place& place : places_) {
            ++starts[digitOf(place) + 1];
        }
        for (std::uint32_t digit = 0; digit < digits; ++digit) {
            starts[digit + 1] += starts[digit];
        }
        for (const Place& place : places_) {
            places2_[starts[digitOf(place)]++] = place;
        }
        places_.swap(places2_);
    }
}

void BoxTree::buildLevel() {
    BoxTreeLevel level;
    level.firstBlock = static_cast<std::uint32_t>(blocks_.size());
    for (const Box& box : boxes_) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float most = std::max(-box.low[axis], box.high[axis]);
            level.radius = std::max(level.radius, static_cast<double>(most));
        }
    }
    buildParents();
    level.firstInner = static_cast<std::uint32_t>(blocks_.size());
    while (boxes_.size() > 1) {
        buildParents();
    }
    level.root = boxes_.front().children;
    levels_.push_back(level);
}

// Puts boxes that follow one another into blocks, and the blocks' bounds in the boxes' place.
void BoxTree::buildParents() {
    constexpr float kFarApart = 16;
    const auto count = static_cast<std::uint32_t>(boxes_.size());
    std::uint32_t blockCount = 0;
    float edges = 0;
    for (std::uint32_t first = 0; first < count;) {
        const float usual =
            blockCount == 0 ? kFloatInfinity : edges / static_cast<float>(blockCount);
        const std::uint32_t last = neighbours(first, kFarApart * usual);
        TreeNode8 block = emptyBlock();
        Box bounds = boxes_[first];
        for (std::uint32_t k = 0; first + k < last; ++k) {
            const Box& box = boxes_[first + k];
            for (std::size_t axis = 0; axis < 3; ++axis) {
                block.bounds[axis][k] = box.low[axis];
                block.bounds[axis + 3][k] = box.high[axis];
            }
            block.children[k] = box.children;
            bounds.extend(box);
        }
        block.count = last - first;
        bounds.children = static_cast<std::uint32_t>(blocks_.size());
        blocks_.push_back(block);
        boxes_[blockCount++] = bounds;
        edges += bounds.longestEdge();
        first = last;
    }
    boxes_.resize(blockCount);
}

// One past the last box that shares a block with the first: as many as fit, but no more than two
// where the next one is far apart. At least two, so that each storey halves the one below.
std::uint32_t BoxTree::neighbours(std::uint32_t first, float farApart) const {
    const auto count = static_cast<std::uint32_t>(boxes_.size());
    const std::uint32_t most = std::min(first + kBlockWidth, count);
    Box bounds = boxes_[first];
    for (std::uint32_t last = first + 1; last < most; ++last) {
        bounds.extend(boxes_[last]);
        if (last >= first + 2 && bounds.longestEdge() > farApart) {
            return last;
        }
    }
    return most;
}

BoxTree::Box BoxTree::boxOf(const TreeNode8& block, std::uint32_t lane) {
    Box box{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.low[axis] = block.bounds[axis][lane];
        box.high[axis] = block.bounds[axis + 3][lane];
    }
    box.children = block.children[lane];
    return box;
}

float BoxTree::Box::longestEdge() const noexcept {
    return std::max({0.0F, high[0] - low[0], high[1] - low[1], high[2] - low[2]});
}

void BoxTree::Box::extend(const Box& other) noexcept {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], other.low[axis]);
        high[axis] = std::max(high[axis], other.high[axis]);
    }
}

std::size_t BoxTree::memoryBytes() const noexcept {
    return levels_.capacity() * sizeof(BoxTreeLevel) + blocks_.capacity() * sizeof(TreeNode8) +
           (boxes_.capacity() + unsorted_.capacity()) * sizeof(Box) +
           (places_.capacity() + places2_.capacity()) * sizeof(Place);
}

void BoxTree::releaseUnusedMemory() noexcept {
    levels_.shrink_to_fit();
    blocks_.shrink_to_fit();
    freeArrays(boxes_, unsorted_, places_, places2_);
}

std::string BoxTree::validate() const {
    std::vector<std::uint32_t> timesBelow(blocks_.size(), 0);
    for (const BoxTreeLevel& level : levels_) {
        ++timesBelow[level.root];
        for (std::uint32_t index = level.firstBlock; index <= level.root; ++index) {
            const TreeNode8& block = blocks_[index];
            if (block.count < 1 || block.count > kBlockWidth) {
                return "A block has one to eight boxes: broken.";
            }
            for (std::uint32_t k = 0; k < kBlockWidth; ++k) {
                const Box box = boxOf(block, k);
                if (k >= block.count) {
                    if (box.low[0] != kFloatInfinity || box.high[0] != -kFloatInfinity) {
                        return "Lanes without a box are met by nothing: broken.";
                    }
                    continue;
                }
                Box grown = box;
                if (index >= level.firstInner) {
                    ++timesBelow[block.children[k]];
                    for (std::uint32_t i = 0; i < blocks_[block.children[k]].count; ++i) {
                        grown.extend(boxOf(blocks_[block.children[k]], i));
                    }
                }
                if (grown.low != box.low || grown.high != box.high) {
                    return "Every block but the roots stands below one lane of one "
                           "block, in the "
                           "lane's box: broken.";
                }
                const float most = std::max(
                    {-box.low[0], -box.low[1], -box.low[2], box.high[0], box.high[1], box.high[2]});
                if (static_cast<double>(most) > level.radius) {
                    return "A level's radius covers its boxes: broken.";
                }
            }
        }
    }
    const bool allOnce = std::all_of(timesBelow.begin(), timesBelow.end(),
                                     [](std::uint32_t times) { return times == 1; });
    return allOnce ? std::string()
                   : "Every block but the roots stands below one lane of one "
                     "block, in the lane's "
                     "box: broken.";
}

}  // namespace hashphase::detail
