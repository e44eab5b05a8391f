// SPDX-License-Identifier: Zlib

// What it costs to be far from the origin, and to shift the origin: the same frames for grids that
// have them at home and far away.

#include <tests/benchmarks/grid_contestant.hpp>
#include <tests/benchmarks/pair_workload.hpp>

#include <utility>

namespace hashphase::benchmarks {
namespace {

// A scene whose coordinates are multiples of a millimetre, about, so that they are exact far away.
class LatticeScene : public demos::BoxScene {
public:
    explicit LatticeScene(std::unique_ptr<demos::BoxScene> scene) : scene_(std::move(scene)) {
        filters_ = scene_->filters();
        round();
    }
    void advance() override {
        scene_->advance();
        round();
    }
    [[nodiscard]] Aabb<float> bounds() const override {
        const Vector3<float> step = Vector3<float>::Constant(kStep);
        return {scene_->bounds().min() - step, scene_->bounds().max() + step};
    }

private:
    static constexpr float kStep = 0x1p-10F;

    void round() {
        const auto rounded = [](const Vector3<float>& x) -> Vector3<float> {
            return (x / kStep).array().round() * kStep;
        };
        boxes_.clear();
        for (const Aabb<float>& box : scene_->boxes()) {
            boxes_.emplace_back(rounded(box.min()), rounded(box.max()));
        }
    }

    std::unique_ptr<demos::BoxScene> scene_;
};

std::vector<ContestantKind> farKinds() {
    return {
        farGridKind("home", {}),
        farGridKind("at-2^20", {.distance = 0x1p20}),
        farGridKind("at-2^30", {.distance = 0x1p30}),
        farGridKind("shifting", {.distance = 0x1p30, .shift = 0x1p20}),
        farGridKind("home-single", {.isDouble = false}),
        farGridKind("at-2^12-single", {.distance = 0x1p12, .isDouble = false}),
        farGridKind("shifting-single", {.distance = 0x1p12, .shift = 0x1p11, .isDouble = false})};
}

Benchmark far(const char* name, const char* description, const MakeScene& makeScene) {
    return {.name = name,
            .group = "far",
            .description = description,
            .sizes = {30'000, 100'000},
            .onRequest = true,
            .contestants = [](std::size_t, std::uint64_t) { return farKinds(); },
            .make = makePairWorkload([makeScene](std::size_t objects, std::uint64_t seed) {
                return std::make_unique<LatticeScene>(makeScene(objects, seed));
            })};
}

}  // namespace

std::vector<Benchmark> farBenchmarks() {
    return {far("far-uniform", "S2-uniform, near the origin and far from it",
                brownian(demos::uniformBoxes)),
            far("far-resting", "uniform boxes of which 2 % move, near and far",
                brownian(demos::restingBoxes))};
}

}  // namespace hashphase::benchmarks
