// SPDX-License-Identifier: Zlib
#include <demos/accuracy/baselines/paper_map.hpp>
#include <demos/paper/phase_makers.hpp>

#include <algorithm>
#include <utility>

namespace hashphase::demos {
namespace {

ConvexRegion<float> frustumOf(const TestBed& bed, Containment containment = Containment::touching) {
    return frustumRegion<float>(bed.view().viewProjection, kDepthRange, wholeScreen<float>(),
                                containment);
}

/// Every object against the frustum.
class BruteVisibility final : public PhaseMethod {
public:
    explicit BruteVisibility(Subjects subjects) : subjects_(std::move(subjects)) {}

    void run(const TestBed& bed) override {
        const ConvexRegion<float> frustum = frustumOf(bed);
        visible_.clear();
        for (const std::uint32_t object : subjects_.list()) {
            if (frustum.key(bed.boxes()[object]) >= 0) {
                visible_.push_back(object);
            }
        }
    }

    [[nodiscard]] PhaseAnswer answer() const override {
        return {{visible_.begin(), visible_.end()}, {}};
    }
    [[nodiscard]] std::size_t memoryBytes() const override {
        return visible_.capacity() * sizeof(std::uint32_t);
    }

private:
    Subjects subjects_;
    std::vector<std::uint32_t> visible_;
};

/// The paper's free camera: every cell that has objects against the frustum. The boxes of cells are
/// stored, as high as the domain; of a cell that is wholly inside all objects are taken, of one that
/// is cut those that touch the frustum, and an object in several cells is listed once.
class PaperVisibility final : public PhaseMethod {
public:
    PaperVisibility(const TestBed& bed, float cellSize) : map_(bed.domain(), cellSize) {
        const Aabb<float> domain = bed.domain();
        const PaperMap::Range all = map_.all();
        for (int z = all.lowZ; z <= all.highZ; ++z) {
            for (int x = all.lowX; x <= all.highX; ++x) {
                Aabb<float> box = map_.square(x, z);
                box.min().y() = domain.min().y();
                box.max().y() = domain.max().y();
                // What rounding files in the cell is in its box too.
                constexpr float kSlack = 0.01F;  // [m]
                box.min().array() -= kSlack;
                box.max().array() += kSlack;
                cells_.push_back({x, z, box});
            }
        }
    }

    void hash(const TestBed& bed) override { map_.refile(bed.boxes()); }

    void run(const TestBed& bed) override {
        const ConvexRegion<float> frustum = frustumOf(bed);
        const ConvexRegion<float> inside = frustumOf(bed, Containment::inside);
        visible_.clear();
        isListed_.assign(bed.objects(), 0);
        for (const Cell& cell : cells_) {
            const std::span<const std::uint32_t> bucket = map_.objects(cell.x, cell.z);
            if (bucket.empty() || frustum.key(cell.box) < 0) {
                continue;
            }
            const bool isInside = inside.key(cell.box) >= 0;
            for (const std::uint32_t object : bucket) {
                if (isListed_[object] == 0 && (isInside || frustum.key(bed.boxes()[object]) >= 0)) {
                    isListed_[object] = 1;
                    visible_.push_back(object);
                }
            }
        }
    }

    [[nodiscard]] PhaseAnswer answer() const override {
        std::vector<std::uint64_t> found(visible_.begin(), visible_.end());
        std::sort(found.begin(), found.end());
        return {std::move(found), {}};
    }
    [[nodiscard]] std::size_t memoryBytes() const override {
        return map_.memoryBytes() + cells_.capacity() * sizeof(Cell) +
               visible_.capacity() * sizeof(std::uint32_t) + isListed_.capacity();
    }

private:
    struct Cell {
        int x;
        int z;
        Aabb<float> box;
    };

    PaperMap map_;
    std::vector<Cell> cells_;
    std::vector<std::uint32_t> visible_;
    std::vector<char> isListed_;  // by object
};

}  // namespace

std::unique_ptr<PhaseMethod> bruteVisibility(Subjects subjects) {
    return std::make_unique<BruteVisibility>(std::move(subjects));
}

std::unique_ptr<PhaseMethod> paperVisibility(const TestBed& bed, float cellSize) {
    return std::make_unique<PaperVisibility>(bed, cellSize);
}

}  // namespace hashphase::demos
