// SPDX-License-Identifier: Zlib
#pragma once

#include <tests/benchmarks/contestant.hpp>

#include <memory>
#include <utility>
#include <vector>

namespace hashphase::benchmarks {

/// A scene and its current boxes in all the forms that contestants take.
class SceneBoxes {
public:
    explicit SceneBoxes(std::unique_ptr<demos::BoxScene> scene) : scene_(std::move(scene)) {
        convert();
    }

    void advance() {
        scene_->advance();
        convert();
    }

    [[nodiscard]] FrameBoxes frame() const {
        return {scene_->boxes(), bulletBoxes_, scene_->filters()};
    }
    [[nodiscard]] const std::vector<Aabb<float>>& boxes() const { return scene_->boxes(); }
    [[nodiscard]] std::size_t size() const { return scene_->boxes().size(); }
    [[nodiscard]] demos::BroadphaseNeeds needs() const { return {scene_->bounds(), size()}; }

private:
    void convert() { demos::toBulletBoxes(scene_->boxes(), bulletBoxes_); }

    std::unique_ptr<demos::BoxScene> scene_;
    std::vector<demos::BulletBox> bulletBoxes_;
};

}  // namespace hashphase::benchmarks
