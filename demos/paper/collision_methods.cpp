// SPDX-License-Identifier: Zlib
#include <demos/accuracy/baselines/paper_map.hpp>
#include <demos/paper/collision_parts.hpp>
#include <demos/paper/phase_makers.hpp>

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace hashphase::demos {
namespace {

PhaseAnswer sortedAnswer(std::vector<std::uint64_t> pairs, std::vector<float> numbers) {
    std::sort(pairs.begin(), pairs.end());
    return {std::move(pairs), std::move(numbers)};
}

/// All boxes with all boxes, and for each the triangles one by one until one has it.
class BruteCollision final : public PhaseMethod {
public:
    explicit BruteCollision(Subjects subjects) : subjects_(std::move(subjects)) {}

    void run(const TestBed& bed) override {
        states_.begin(bed);
        pairs_.clear();
        const std::vector<Aabb<float>>& boxes = bed.boxes();
        for (const std::uint32_t a : subjects_.list()) {
            const Aabb<float>& box = boxes[a];
            for (std::uint32_t b = subjects_.areAll() ? a + 1 : 0; b < boxes.size(); ++b) {
                // Of two subjects, the first one has seen the pair.
                if (overlaps(box, boxes[b]) && (b > a || !subjects_.contains(b))) {
                    pairs_.push_back(pairKeyOf(a, b));
                    states_.meet(a, b);
                }
            }
        }
    }

    void stand(const TestBed& bed) override {
        std::vector<std::uint32_t> all(bed.ground().boxes.size());
        std::iota(all.begin(), all.end(), 0U);
        for (const std::uint32_t object : subjects_.list()) {
            const Vector3<float>& centre = bed.centres()[object];
            states_.stand(object, groundHeight(bed.ground(), all, centre.x(), centre.z()));
        }
    }

    [[nodiscard]] PhaseAnswer answer() const override {
        return sortedAnswer(pairs_, states_.numbers(subjects_));
    }
    [[nodiscard]] std::size_t memoryBytes() const override {
        return states_.memoryBytes() + pairs_.capacity() * sizeof(pairs_[0]);
    }

private:
    Subjects subjects_;
    SphereStates states_;
    std::vector<std::uint64_t> pairs_;
};

/// The paper's: all buckets wiped, every sphere filed in each cell that its box touches, those of a
/// bucket compared with each other; triangles filed once, in cells of the same size.
class PaperCollision final : public PhaseMethod {
public:
    PaperCollision(const TestBed& bed, float cellSize)
        : spheres_(bed.domain(), cellSize), triangles_(bed.ground().boxes, cellSize) {}

    void hash(const TestBed& bed) override { spheres_.refile(bed.boxes()); }

    void run(const TestBed& bed) override {
        states_.begin(bed);
        pairs_.clear();
        const PaperMap::Range all = spheres_.all();
        for (int z = all.lowZ; z <= all.highZ; ++z) {
            for (int x = all.lowX; x <= all.highX; ++x) {
                collide(x, z, bed.boxes());
            }
        }
    }

    void stand(const TestBed& bed) override {
        for (std::uint32_t object = 0; object < bed.objects(); ++object) {
            const float x = bed.centres()[object].x();
            const float z = bed.centres()[object].z();
            const PaperMap::Cell cell = triangles_.cellAt(x, z);
            states_.stand(object,
                          groundHeight(bed.ground(), triangles_.objects(cell.x, cell.z), x, z));
        }
    }

    [[nodiscard]] PhaseAnswer answer() const override {
        return sortedAnswer(pairs_, states_.numbers(Subjects::all(states_.size())));
    }
    [[nodiscard]] std::size_t memoryBytes() const override {
        return spheres_.memoryBytes() + triangles_.memoryBytes() + states_.memoryBytes() +
               pairs_.capacity() * sizeof(pairs_[0]);
    }

private:
    void collide(int x, int z, std::span<const Aabb<float>> boxes) {
        const std::span<const std::uint32_t> bucket = spheres_.objects(x, z);
        for (std::size_t i = 0; i < bucket.size(); ++i) {
            const Aabb<float>& a = boxes[bucket[i]];
            for (const std::uint32_t other : bucket.subspan(i + 1)) {
                if (overlaps(a, boxes[other]) && isHome(x, z, a, boxes[other])) {
                    pairs_.push_back(pairKeyOf(bucket[i], other));
                    states_.meet(bucket[i], other);
                }
            }
        }
    }

    /// Of the cells that the two share, the one where their overlap begins: a pair counts once.
    [[nodiscard]] bool isHome(int x, int z, const Aabb<float>& a, const Aabb<float>& b) const {
        const float lowX = std::max(a.min().x(), b.min().x());
        const float lowZ = std::max(a.min().z(), b.min().z());
        const PaperMap::Cell home = spheres_.cellAt(lowX, lowZ);
        return home.x == x && home.z == z;
    }

    PaperMap spheres_;
    PaperMap triangles_;
    SphereStates states_;
    std::vector<std::uint64_t> pairs_;
};

}  // namespace

std::vector<float> SphereStates::numbers(const Subjects& subjects) const {
    std::vector<float> numbers;
    numbers.reserve(4 * subjects.list().size());
    for (const std::uint32_t object : subjects.list()) {
        const Vector3<float>& velocity = after_[object];
        numbers.insert(numbers.end(), {heights_[object], velocity.x(), velocity.y(), velocity.z()});
    }
    return numbers;
}

std::unique_ptr<PhaseMethod> bruteCollision(Subjects subjects) {
    return std::make_unique<BruteCollision>(std::move(subjects));
}

std::unique_ptr<PhaseMethod> paperCollision(const TestBed& bed, float cellSize) {
    return std::make_unique<PaperCollision>(bed, cellSize);
}

}  // namespace hashphase::demos
