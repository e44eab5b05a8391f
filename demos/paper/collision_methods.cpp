// SPDX-License-Identifier: Zlib
#include <broadphase/pairs.hpp>
#include <demos/accuracy/baselines/paper_map.hpp>
#include <demos/paper/phase_method.hpp>
#include <integration/terrain/terrain.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

namespace hashphase::demos {
namespace {

/// What becomes of the spheres once their pairs are found: where they stand and how they fly on.
class CollisionMethod : public PhaseMethod {
public:
    CollisionMethod(const MethodPlan& /*plan*/, const TestBed& /*bed*/, Subjects subjects)
        : subjects_(std::move(subjects)) {}

    [[nodiscard]] PhaseAnswer answer() const override {
        PhaseAnswer answer{keys_, {}};
        std::sort(answer.found.begin(), answer.found.end());
        for (const std::uint32_t object : subjects_.list()) {
            const Vector3<float>& velocity = after_[object];
            answer.numbers.insert(answer.numbers.end(),
                                  {heights_[object], velocity.x(), velocity.y(), velocity.z()});
        }
        return answer;
    }
    [[nodiscard]] std::size_t memoryBytes() const override {
        return after_.capacity() * sizeof(after_[0]) + heights_.capacity() * sizeof(float) +
               keys_.capacity() * sizeof(keys_[0]);
    }

protected:
    /// Begins a frame: nobody has met anybody.
    void begin(const TestBed& bed) {
        centres_ = bed.centres();
        before_ = bed.velocities();
        after_.assign(before_.begin(), before_.end());
        heights_.assign(centres_.size(), 0);
        keys_.clear();
    }

    /// Two whose boxes overlap: if the spheres touch and approach, they exchange their speeds along
    /// the line between them, as they were when the frame began, so the order does not matter.
    void meet(std::uint32_t a, std::uint32_t b) {
        constexpr float kTouching = 2 * PaperScene::kRadius;
        const Vector3<float> between = centres_[b] - centres_[a];
        const float squared = between.squaredNorm();
        const float approach = (before_[a] - before_[b]).dot(between);
        if (squared <= kTouching * kTouching && approach > 0) {
            const Vector3<float> exchanged = between * (approach / squared);
            after_[a] -= exchanged;
            after_[b] += exchanged;
        }
    }

    /// The sphere rests on ground of that height [m].
    void restOn(std::uint32_t object, float groundHeight) {
        heights_[object] = groundHeight + PaperScene::kRadius;
    }

    Subjects subjects_;
    std::vector<std::uint64_t> keys_;  // of what lists them itself

private:
    std::span<const Vector3<float>> centres_;
    std::span<const Vector3<float>> before_;
    std::vector<Vector3<float>> after_;
    std::vector<float> heights_;
};

/// The height of the ground below the centre. No surface is vertical or above another one, so the first
/// of the triangles that has the place is the answer; 0 where none has. Edges belong to both sides.
float groundHeight(const TriangleGround& ground, std::span<const std::uint32_t> triangles,
                   const Vector3<float>& centre) {
    constexpr float kEdge = 1e-5F;  // rounding must not lose a point between two triangles
    const float x = centre.x();
    const float z = centre.z();
    for (const std::uint32_t triangle : triangles) {
        const Aabb<float>& box = ground.boxes[triangle];
        if (x < box.min().x() || x > box.max().x() || z < box.min().z() || z > box.max().z()) {
            continue;
        }
        if (const auto height = ground.heightAt(triangle, x, z, kEdge)) {
            return *height;
        }
    }
    return 0;
}

/// All boxes with all boxes, and for each the triangles one by one until one has it.
class BruteCollision final : public CollisionMethod {
public:
    using CollisionMethod::CollisionMethod;

    void run(const TestBed& bed) override {
        begin(bed);
        const std::vector<Aabb<float>>& boxes = bed.boxes();
        for (const std::uint32_t a : subjects_.list()) {
            const Aabb<float>& box = boxes[a];
            for (std::uint32_t b = subjects_.areAll() ? a + 1 : 0; b < boxes.size(); ++b) {
                // Of two subjects, the first one has seen the pair.
                if (overlaps(box, boxes[b]) && (b > a || !subjects_.contains(b))) {
                    keys_.push_back(pairKey(a, b));
                    meet(a, b);
                }
            }
        }
    }

    void stand(const TestBed& bed) override {
        std::vector<std::uint32_t> all(bed.ground().boxes.size());
        std::iota(all.begin(), all.end(), 0U);
        for (const std::uint32_t object : subjects_.list()) {
            restOn(object, groundHeight(bed.ground(), all, bed.centres()[object]));
        }
    }
};

/// The paper's: all buckets wiped, every sphere filed in each cell that its box touches, those of a
/// bucket compared with each other; triangles filed once, in cells of the same size.
class PaperCollision final : public CollisionMethod {
public:
    PaperCollision(const MethodPlan& plan, const TestBed& bed, Subjects subjects)
        : CollisionMethod(plan, bed, std::move(subjects)),
          spheres_(bed.domain(), static_cast<float>(plan.cellSize)),
          triangles_(bed.ground().boxes, static_cast<float>(plan.cellSize)) {}

    void hash(const TestBed& bed) override { spheres_.refile(bed.boxes()); }

    void run(const TestBed& bed) override {
        begin(bed);
        forEachCell(spheres_.all(), [&](int x, int z) { collide(x, z, bed.boxes()); });
    }

    void stand(const TestBed& bed) override {
        for (std::uint32_t object = 0; object < bed.objects(); ++object) {
            const Vector3<float>& centre = bed.centres()[object];
            const PaperMap::Cell cell = triangles_.cellAt(centre.x(), centre.z());
            restOn(object, groundHeight(bed.ground(), triangles_.objects(cell.x, cell.z), centre));
        }
    }

    [[nodiscard]] std::size_t memoryBytes() const override {
        return spheres_.memoryBytes() + triangles_.memoryBytes() + CollisionMethod::memoryBytes();
    }

private:
    void collide(int x, int z, std::span<const Aabb<float>> boxes) {
        const std::span<const std::uint32_t> bucket = spheres_.objects(x, z);
        for (std::size_t i = 0; i < bucket.size(); ++i) {
            const Aabb<float>& a = boxes[bucket[i]];
            for (const std::uint32_t other : bucket.subspan(i + 1)) {
                if (overlaps(a, boxes[other]) && isHome(x, z, a, boxes[other])) {
                    keys_.push_back(pairKey(bucket[i], other));
                    meet(bucket[i], other);
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
};

/// Pairs keep track from frame to frame, and file what has moved; the terrain is asked for all at
/// once.
class HashCollision final : public OnGrid<CollisionMethod> {
public:
    HashCollision(const MethodPlan& plan, const TestBed& bed, Subjects subjects)
        : OnGrid(plan, bed, std::move(subjects)),
          pairs_(grid_),
          triangles_({.cellSize = plan.cellSize}),
          terrain_(triangles_) {
        terrain_.add(bed.ground().vertices, bed.ground().indices);
        triangles_.update();
    }

    void hash(const TestBed& /*bed*/) override {}

    void run(const TestBed& bed) override {
        begin(bed);
        moveAll(bed);
        const PairChanges changes = pairs_.update([](ProxyId, ProxyId) { return true; });
        survived_.clear();
        std::set_difference(current_.begin(), current_.end(), changes.died.begin(),
                            changes.died.end(), std::back_inserter(survived_));
        current_.clear();
        std::merge(survived_.begin(), survived_.end(), changes.born.begin(), changes.born.end(),
                   std::back_inserter(current_));
        for (const auto& [a, b] : current_) {
            meet(a.index, b.index);
        }
    }

    void stand(const TestBed& bed) override {
        above_.resize(bed.objects());
        grounds_.resize(bed.objects());
        for (std::size_t i = 0; i < above_.size(); ++i) {
            above_[i] = bed.centres()[i];
            above_[i].y() = Terrain::kHighest + 1;
        }
        terrain_.surfacesBelow(above_, grounds_);
        for (std::uint32_t i = 0; i < bed.objects(); ++i) {
            restOn(i, grounds_[i] ? grounds_[i]->height : 0);
        }
    }

    [[nodiscard]] PhaseAnswer answer() const override {
        PhaseAnswer answer = OnGrid::answer();
        for (const auto& [a, b] : current_) {
            answer.found.push_back(pairKey(a.index, b.index));
        }
        return answer;
    }

    [[nodiscard]] std::size_t memoryBytes() const override {
        return pairs_.memoryBytes() + triangles_.memoryBytes() + terrain_.memoryBytes() +
               OnGrid::memoryBytes() +
               (current_.capacity() + survived_.capacity()) * sizeof(ProxyPair) +
               above_.capacity() * sizeof(above_[0]) + grounds_.capacity() * sizeof(grounds_[0]);
    }

private:
    Pairs<float> pairs_;
    Grid<float> triangles_;
    hashphase::Terrain<float> terrain_;
    std::vector<ProxyPair> current_;  // sorted
    std::vector<ProxyPair> survived_;
    std::vector<Vector3<float>> above_;
    std::vector<hashphase::Terrain<float>::Found> grounds_;
};

}  // namespace

std::unique_ptr<PhaseMethod> makeCollisionMethod(const MethodPlan& plan, const TestBed& bed,
                                                 Subjects subjects) {
    return makeOneOf<BruteCollision, PaperCollision, HashCollision>(plan, bed, std::move(subjects));
}

}  // namespace hashphase::demos
