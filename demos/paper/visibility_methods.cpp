// SPDX-License-Identifier: Zlib
#include <demos/accuracy/baselines/paper_map.hpp>
#include <demos/paper/phase_method.hpp>
#include <integration/culling/culler.hpp>

#include <algorithm>
#include <utility>

namespace hashphase::demos {
namespace {

ConvexRegion<float> frustumOf(const TestBed& bed, Containment containment = Containment::touching) {
    return frustumRegion<float>(bed.view().viewProjection, kDepthRange, wholeScreen<float>(),
                                containment);
}

/// Whose list has the visible objects.
class VisibilityMethod : public ListMethod {
public:
    using ListMethod::ListMethod;

    [[nodiscard]] PhaseAnswer answer() const override {
        PhaseAnswer answer;
        for (const std::uint32_t object : list_) {
            answer.found.push_back(keyOf(object, object));
        }
        std::sort(answer.found.begin(), answer.found.end());
        return answer;
    }
};

/// Every object against the frustum.
class BruteVisibility final : public VisibilityMethod {
public:
    using VisibilityMethod::VisibilityMethod;

    void run(const TestBed& bed) override {
        const ConvexRegion<float> frustum = frustumOf(bed);
        list_.clear();
        for (const std::uint32_t object : subjects_.list()) {
            if (frustum.key(bed.boxes()[object]) >= 0) {
                list_.push_back(object);
            }
        }
    }
};

/// The paper's free camera: every cell that has objects against the frustum. The boxes of cells are
/// stored, as high as the domain; of a cell that is wholly inside all objects are taken, of one that
/// is cut those that touch the frustum, and an object in several cells is listed once.
class PaperVisibility final : public VisibilityMethod {
public:
    PaperVisibility(const MethodPlan& plan, const TestBed& bed, Subjects subjects)
        : VisibilityMethod(plan, bed, std::move(subjects)),
          map_(bed.domain(), static_cast<float>(plan.cellSize)) {
        const Aabb<float> domain = bed.domain();
        forEachCell(map_.all(), [&](int x, int z) {
            Aabb<float> box = map_.square(x, z);
            box.min().y() = domain.min().y();
            box.max().y() = domain.max().y();
            // What rounding files in the cell is in its box too.
            constexpr float kSlack = 0.01F;  // [m]
            box.min().array() -= kSlack;
            box.max().array() += kSlack;
            cells_.push_back({x, z, box});
        });
    }

    void hash(const TestBed& bed) override { map_.refile(bed.boxes()); }

    void run(const TestBed& bed) override {
        const ConvexRegion<float> frustum = frustumOf(bed);
        const ConvexRegion<float> inside = frustumOf(bed, Containment::inside);
        list_.clear();
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
                    list_.push_back(object);
                }
            }
        }
    }

    [[nodiscard]] std::size_t memoryBytes() const override {
        return map_.memoryBytes() + cells_.capacity() * sizeof(Cell) + isListed_.capacity() +
               VisibilityMethod::memoryBytes();
    }

private:
    struct Cell {
        int x;
        int z;
        Aabb<float> box;
    };

    PaperMap map_;
    std::vector<Cell> cells_;
    std::vector<char> isListed_;  // by object
};

class HashVisibility final : public OnGrid<VisibilityMethod> {
public:
    using OnGrid::OnGrid;

    void run(const TestBed& bed) override {
        culler_.look(grid_, frustumOf(bed));
        list_.clear();
        culler_.forEach([this](std::uint32_t object) { list_.push_back(object); });
    }

    [[nodiscard]] std::size_t memoryBytes() const override {
        return culler_.memoryBytes() + OnGrid::memoryBytes();
    }

private:
    Culler<float> culler_;
};

}  // namespace

std::unique_ptr<PhaseMethod> makeVisibilityMethod(const MethodPlan& plan, const TestBed& bed,
                                                  Subjects subjects) {
    return makeOneOf<BruteVisibility, PaperVisibility, HashVisibility>(plan, bed,
                                                                       std::move(subjects));
}

}  // namespace hashphase::demos
