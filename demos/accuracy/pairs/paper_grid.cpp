// SPDX-License-Identifier: Zlib
#include <demos/accuracy/pairs/pair_experiments.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

namespace hashphase::demos {
namespace {

using Cell = std::array<std::int32_t, 3>;

struct CellSpan {
    Cell lowest;
    Cell highest;
};

Cell cellOf(const btVector3& point, btScalar inverseCellSize) {
    Cell cell{};
    for (int axis = 0; axis < 3; ++axis) {
        cell[static_cast<std::size_t>(axis)] =
            static_cast<std::int32_t>(std::floor(point[axis] * inverseCellSize));
    }
    return cell;
}

CellSpan cellsOf(const BulletBox& box, btScalar inverseCellSize) {
    return {cellOf(box.min, inverseCellSize), cellOf(box.max, inverseCellSize)};
}

class PaperGrid {
public:
    PaperGrid(double cellSize, FiledCells filed)
        : inverseCellSize_(static_cast<btScalar>(1 / cellSize)), filed_(filed) {}

    void step(std::span<const BulletBox> boxes) {
        hash(boxes);
        fillBuckets();
        pairs_.clear();
        tested_ = 0;
        for (std::size_t bucket = 0; bucket + 1 < begins_.size(); ++bucket) {
            collide(boxes,
                    {buckets_.data() + begins_[bucket], buckets_.data() + begins_[bucket + 1]});
        }
        std::sort(pairs_.begin(), pairs_.end());
        pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
    }

    [[nodiscard]] const std::vector<PairKey>& pairs() const { return pairs_; }
    [[nodiscard]] std::uint64_t boxesTested() const { return tested_; }

private:
    /// An object in a cell.
    struct Reference {
        Cell cell;
        std::uint32_t object;
    };

    void hash(std::span<const BulletBox> boxes) {
        references_.clear();
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const CellSpan span = cellsOf(boxes[i], inverseCellSize_);
            const Cell step = stepsOver(span);
            Cell cell = span.lowest;
            for (cell[2] = span.lowest[2]; cell[2] <= span.highest[2]; cell[2] += step[2]) {
                for (cell[1] = span.lowest[1]; cell[1] <= span.highest[1]; cell[1] += step[1]) {
                    for (cell[0] = span.lowest[0]; cell[0] <= span.highest[0]; cell[0] += step[0]) {
                        references_.push_back({cell, static_cast<std::uint32_t>(i)});
                    }
                }
            }
        }
    }

    /// From one cell to the next: by corners only, from the first to the last.
    [[nodiscard]] Cell stepsOver(const CellSpan& span) const {
        Cell steps{1, 1, 1};
        for (std::size_t axis = 0; filed_ == FiledCells::kCorners && axis < 3; ++axis) {
            steps[axis] = std::max(1, span.highest[axis] - span.lowest[axis]);
        }
        return steps;
    }

    [[nodiscard]] std::size_t bucketOf(const Cell& cell) const {
        const auto x = static_cast<std::uint32_t>(cell[0]) * 73856093U;
        const auto y = static_cast<std::uint32_t>(cell[1]) * 19349663U;
        const auto z = static_cast<std::uint32_t>(cell[2]) * 83492791U;
        return (x ^ y ^ z) & (begins_.size() - 2);
    }

    /// A counting sort of the references by bucket.
    void fillBuckets() {
        begins_.assign(std::bit_ceil(references_.size() + 1) + 1, 0);
        for (const Reference& reference : references_) {
            ++begins_[bucketOf(reference.cell)];
        }
        std::uint32_t end = 0;
        for (std::uint32_t& begin : begins_) {
            end += begin;
            begin = end;
        }
        buckets_.resize(references_.size());
        for (const Reference& reference : references_) {
            buckets_[--begins_[bucketOf(reference.cell)]] = reference;
        }
    }

    void collide(std::span<const BulletBox> boxes, std::span<const Reference> bucket) {
        for (std::size_t i = 0; i < bucket.size(); ++i) {
            for (std::size_t j = i + 1; j < bucket.size(); ++j) {
                const Reference& a = bucket[i];
                const Reference& b = bucket[j];
                if (a.cell != b.cell) {
                    continue;
                }
                ++tested_;
                if (overlap(boxes[a.object], boxes[b.object])) {
                    pairs_.push_back(pairKey(a.object, b.object));
                }
            }
        }
    }

    btScalar inverseCellSize_;
    FiledCells filed_;
    std::vector<Reference> references_;
    std::vector<std::uint32_t> begins_;  // of the buckets; a power of two of them, and the end
    std::vector<Reference> buckets_;
    std::vector<PairKey> pairs_;
    std::uint64_t tested_ = 0;
};

}  // namespace

PairMethod paperGridMethod(std::string name, double cellSize, FiledCells filed) {
    return {{std::move(name), filed == FiledCells::kAll ? "paper exact complete" : "paper",
             [=](const BroadphaseNeeds& /*needs*/, std::span<const BulletBox> /*boxes*/) {
                 const auto grid = std::make_shared<PaperGrid>(cellSize, filed);
                 return PairSource{[=](std::span<const BulletBox> boxes) { grid->step(boxes); },
                                   [=](std::vector<PairKey>& pairs) { pairs = grid->pairs(); },
                                   [=] { return grid->boxesTested(); }};
             }}};
}

double filedCellCount(std::span<const BulletBox> boxes, double cellSize) {
    double count = 0;
    for (const BulletBox& box : boxes) {
        const CellSpan span = cellsOf(box, static_cast<btScalar>(1 / cellSize));
        double cells = 1;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            cells *= static_cast<double>(span.highest[axis] - span.lowest[axis]) + 1;
        }
        count += cells;
    }
    return count;
}

}  // namespace hashphase::demos
