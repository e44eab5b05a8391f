// SPDX-License-Identifier: Zlib
#include <demos/accuracy/baselines/paper_map.hpp>
#include <demos/paper/phase_makers.hpp>

#include <algorithm>
#include <utility>

namespace hashphase::demos {
namespace {

ConvexRegion<float> frustumOf(const TestBed& bed) {
    return frustumRegion<float>(bed.view().viewProjection, kDepthRange);
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

/// The paper's free camera: every cell against the frustum, and all objects of those that touch it.
/// Cells are as high as what stands in them, and an object in several is listed once.
class PaperVisibility final : public PhaseMethod {
public:
    PaperVisibility(const TestBed& bed, float cellSize) : map_(bed.boxes(), cellSize) {}

    void hash(const TestBed& bed) override { map_.refile(bed.boxes()); }

    void run(const TestBed& bed) override {
        const ConvexRegion<float> frustum = frustumOf(bed);
        visible_.clear();
        isListed_.assign(bed.objects(), 0);
        const PaperMap::Range all = map_.all();
        for (int z = all.lowZ; z <= all.highZ; ++z) {
            for (int x = all.lowX; x <= all.highX; ++x) {
                lookInto(map_.objects(x, z), bed.boxes(), frustum);
            }
        }
    }

    [[nodiscard]] PhaseAnswer answer() const override {
        std::vector<std::uint64_t> found(visible_.begin(), visible_.end());
        std::sort(found.begin(), found.end());
        return {std::move(found), {}};
    }
    [[nodiscard]] std::size_t memoryBytes() const override {
        return map_.memoryBytes() + visible_.capacity() * sizeof(std::uint32_t) +
               isListed_.capacity();
    }

private:
    void lookInto(std::span<const std::uint32_t> bucket, std::span<const Aabb<float>> boxes,
                  const ConvexRegion<float>& frustum) {
        Aabb<float> cell;
        for (const std::uint32_t object : bucket) {
            cell.extend(boxes[object]);
        }
        if (bucket.empty() || frustum.key(cell) < 0) {
            return;
        }
        for (const std::uint32_t object : bucket) {
            if (isListed_[object] == 0 && frustum.key(boxes[object]) >= 0) {
                isListed_[object] = 1;
                visible_.push_back(object);
            }
        }
    }

    PaperMap map_;
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
