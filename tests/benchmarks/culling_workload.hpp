// SPDX-License-Identifier: Zlib
#pragma once

// What does a camera see, or each of some? All objects move before each frame, and the cameras turn.
// Everybody marks the visible ones by number.

#include <demos/scenes/random.hpp>
#include <tests/benchmarks/scene_boxes.hpp>
#include <tests/benchmarks/workload.hpp>

#include <broadphase/convex_region.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace hashphase::benchmarks {

/// The six planes of a frustum, which face inwards.
using FrustumPlanes = std::array<Eigen::Hyperplane<float, 3>, 6>;

/// Who culls.
class CullingContestant {
public:
    CullingContestant() = default;
    CullingContestant(const CullingContestant&) = delete;
    CullingContestant& operator=(const CullingContestant&) = delete;
    virtual ~CullingContestant() = default;

    /// Takes the boxes of the next frame; not timed.
    virtual void setAll(const FrameBoxes& frame) = 0;

    /// Finds the visible objects; timed.
    virtual void look(const FrustumPlanes& planes) = 0;

    /// Appends them, in any order.
    virtual void listVisible(std::vector<Answer>& visible) const = 0;
};

/// Those who take part.
[[nodiscard]] std::vector<ContestantKind> cullingKinds();

/// Where the cameras stand, seen from the middle of the scene, and how far they see.
struct CullingPlan {
    double backwards = 0;    // from the middle, against its heading, in sides of the scene
    double height = 0;       // above the middle [m]
    double fieldOfView = 1;  // vertical [rad]
    double farPlane = 1;     // in sides of the scene
    int cameras = 1;         // a frame, one after another, in as many directions
    bool isSecond = false;   // only a second look is timed: all that it reads is in the cache
};

class CullingWorkload : public Workload {
public:
    CullingWorkload(std::unique_ptr<demos::BoxScene> scene, CullingPlan plan)
        : scene_(std::move(scene)), plan_(plan) {}

    void add(const ContestantKind& kind) override;
    void beginFrame() override;
    double runFrame(std::size_t contestant) override;
    void listAnswers(std::size_t contestant, std::vector<Answer>& answers) override;
    void listExactAnswers(std::vector<Answer>& answers) override;
    [[nodiscard]] std::size_t objects() const override { return scene_.size(); }
    [[nodiscard]] std::size_t operations() const override {
        return scene_.size() * static_cast<std::size_t>(plan_.cameras);
    }

private:
    SceneBoxes scene_;
    CullingPlan plan_;
    int frame_ = 0;
    std::vector<FrustumPlanes> views_;
    std::vector<std::unique_ptr<CullingContestant>> contestants_;
};

}  // namespace hashphase::benchmarks
