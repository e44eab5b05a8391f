// SPDX-License-Identifier: Zlib
#include <demos/stability/pair_scene.hpp>

#include <demos/scenes/random.hpp>
#include <demos/stability/isolation.hpp>

#include <utility>

namespace hashphase::demos {
namespace {

// Boxes that reach farther have no end.
constexpr float kWithoutEnd = 1e15F;

// Of so many, brute force takes no time.
constexpr std::size_t kFew = 3000;

BulletBox bulletBox(const Aabb<float>& box) {
    return {btVector3(box.min().x(), box.min().y(), box.min().z()),
            btVector3(box.max().x(), box.max().y(), box.max().z())};
}

Aabb<float> nothing() {
    const auto nan = Vector3<float>::Constant(std::numeric_limits<float>::quiet_NaN());
    return {nan, nan};
}

}  // namespace

Aabb<float> cubeAt(const Vector3<float>& center, float edge) {
    const Vector3<float> half = Vector3<float>::Constant(edge / 2);
    return {center - half, center + half};
}

Boxes scatteredCubes(std::size_t count, float side, float smallestEdge, float largestEdge,
                     std::uint64_t seed) {
    Random random(seed);
    const auto coordinate = [&] { return random.between(-side / 2, side / 2); };
    Boxes boxes;
    for (std::size_t i = 0; i < count; ++i) {
        const float x = coordinate();
        const float y = coordinate();
        const float z = coordinate();
        boxes.push_back(cubeAt({x, y, z}, random.between(smallestEdge, largestEdge)));
    }
    return boxes;
}

Aabb<float> worldOf(std::span<const Aabb<float>> boxes) {
    Aabb<float> world;
    for (const Aabb<float>& box : boxes) {
        // Phrased so that NaN is left out.
        if ((box.min().array().abs() < kWithoutEnd).all() &&
            (box.max().array().abs() < kWithoutEnd).all()) {
            world.extend(box.min());
            world.extend(box.max());
        }
    }
    return world.isEmpty() ? Aabb<float>(Vector3<float>(-1, -1, -1), Vector3<float>(1, 1, 1))
                           : world;
}

PairScene::PairScene(const CaseContext& context, Boxes boxes, const GridConfig& grid,
                     const std::optional<Aabb<float>>& world)
    : boxes_(std::move(boxes)),
      filled_(context.kind, {world ? *world : worldOf(boxes_), boxes_.size(), grid}) {
    for (std::uint32_t i = 0; i < size(); ++i) {
        filled_.create(i, bulletBox(boxes_[i]), {});
    }
}

void PairScene::move(std::uint32_t object, const Aabb<float>& box) {
    boxes_[object] = box;
    filled_.set(object, bulletBox(box));
}

void PairScene::destroy(std::uint32_t object) {
    boxes_[object] = nothing();
    filled_.destroy(object);
}

void PairScene::create(std::uint32_t object, const Aabb<float>& box) {
    boxes_[object] = box;
    filled_.create(object, bulletBox(box), {});
}

void PairScene::moveAll(const Boxes& boxes) {
    boxes_ = boxes;
    toBulletBoxes(boxes_, bulletBoxes_);
    filled_.setAll(bulletBoxes_);
}

const std::vector<PairKey>& PairScene::reported() {
    filled_.listPairs(reported_);
    return reported_;
}

const std::vector<PairKey>& PairScene::exact() {
    const LimitPause pause;
    findExactPairs(boxes_.size() <= kFew ? ReferenceMethod::kBrute : ReferenceMethod::kSweep,
                   boxes_, {}, exact_);
    return exact_;
}

void PairScene::judge(CaseTally& tally) {
    findPairs();
    tally.compare(reported(), exact());
}

void judgePairs(const CaseContext& context, CaseTally& tally, const Boxes& boxes,
                const GridConfig& grid) {
    PairScene scene(context, boxes, grid);
    scene.judge(tally);
}

}  // namespace hashphase::demos
