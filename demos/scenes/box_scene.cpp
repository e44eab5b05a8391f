// SPDX-License-Identifier: Zlib
#include <demos/scenes/box_scene.hpp>

#include <demos/scenes/brownian_scene.hpp>
#include <demos/scenes/near_scene.hpp>
#include <demos/scenes/paper_scene.hpp>

#include <array>

namespace hashphase::demos {
namespace {

// --- Terdiman's scene ----------------------------------------------------------------------------

// The boxes on which Pierre Terdiman's "Box pruning revisited" (2017) measures: integer
// coordinates, extents of 0-254 in a cube of 4,096, drawn with Microsoft's rand().

constexpr float kHalfSide = 2048;
constexpr float kLargestHalfExtent = 127;
constexpr int kDrift = 4;  // [units] on an axis in a frame

// The published scene is drawn with 42; ours counts from 1.
constexpr std::uint32_t kSeedBeforeTheFirst = 41;

/// Seed 1 begins as the published scene: exactly 11,811 pairs with 10,000 boxes and 1,144,045 with
/// 100,000. That one stands still; here every box drifts by up to 4 units an axis and frame.
class TerdimanScene : public BoxScene {
public:
    TerdimanScene(std::size_t objects, std::uint64_t seed)
        : state_(kSeedBeforeTheFirst + static_cast<std::uint32_t>(seed)) {
        for (std::size_t i = 0; i < objects; ++i) {
            Vector3<float> centre;
            Vector3<float> halfExtents;
            for (Eigen::Index axis = 0; axis < 3; ++axis) {
                centre[axis] = static_cast<float>(draw() & 4095) - kHalfSide;
            }
            for (Eigen::Index axis = 0; axis < 3; ++axis) {
                halfExtents[axis] = static_cast<float>(draw() & 127);
            }
            centres_.push_back(centre);
            halfExtents_.push_back(halfExtents);
            boxes_.emplace_back(centre - halfExtents, centre + halfExtents);
        }
    }

    void advance() override {
        for (std::size_t i = 0; i < boxes_.size(); ++i) {
            Vector3<float>& centre = centres_[i];
            for (Eigen::Index axis = 0; axis < 3; ++axis) {
                centre[axis] += static_cast<float>(draw() % (2 * kDrift + 1) - kDrift);
            }
            centre = centre.cwiseMax(-kHalfSide).cwiseMin(kHalfSide);
            boxes_[i] = {centre - halfExtents_[i], centre + halfExtents_[i]};
        }
    }

    [[nodiscard]] Aabb<float> bounds() const override {
        const Vector3<float> corner = Vector3<float>::Constant(kHalfSide + kLargestHalfExtent);
        return {-corner, corner};
    }

private:
    /// Microsoft's rand(): 15 bits.
    int draw() noexcept {
        state_ = state_ * 214013U + 2531011U;
        return static_cast<int>(state_ >> 16 & 0x7fff);
    }

    std::uint32_t state_;
    std::vector<Vector3<float>> centres_;
    std::vector<Vector3<float>> halfExtents_;
};

// --- All scenes ----------------------------------------------------------------------------------

template <class Scene>
std::unique_ptr<BoxScene> makeBoxScene(std::size_t objects, std::uint64_t seed) {
    return std::make_unique<Scene>(objects, seed);
}

template <BrownianBoxes (*scatter)(std::size_t, std::uint64_t)>
std::unique_ptr<BoxScene> makeBrownian(std::size_t objects, std::uint64_t seed) {
    return std::make_unique<BrownianScene>(scatter(objects, seed), seed);
}

template <std::size_t period>
BrownianBoxes oneInSoManyMoves(std::size_t objects, std::uint64_t seed) {
    return someMovingBoxes(objects, seed, period);
}

constexpr NearMotion kTrembling{.tremble = 0.01F};
constexpr NearMotion kCreeping{.creep = 0.002F};
constexpr NearMotion kBreathing{.breathe = 0.01F};
constexpr NearMotion kMixed2{.tremble = 0.01F, .travellers = 50};
constexpr NearMotion kMixed20{.tremble = 0.01F, .travellers = 5};

template <const NearMotion& motion>
std::unique_ptr<BoxScene> makeNear(std::size_t objects, std::uint64_t seed) {
    return std::make_unique<NearScene>(objects, seed, motion);
}

constexpr std::array kBoxScenes{
    BoxSceneKind{"paper", "spheres of radius 1 m roaming a random terrain of 400 x 400 m",
                 "spheres", 30'000, makeBoxScene<PaperScene>},
    BoxSceneKind{"uniform", "boxes of 0.5-1.5 m all over a cube, each overlapping about two others",
                 "boxes", 30'000, makeBrownian<uniformBoxes>},
    BoxSceneKind{"piles", "dense piles of 100 boxes, spread over 10 x 10 km", "boxes", 30'000,
                 makeBrownian<pileBoxes>},
    BoxSceneKind{"logsizes", "boxes of 0.1-30 m, as many of each order of magnitude", "boxes",
                 30'000, makeBrownian<logSizeBoxes>},
    BoxSceneKind{
        "resting",
        "uniform boxes of which the same 2 % move, 50 % could move but stay still, 48 % are static",
        "boxes", 100'000, makeBrownian<restingBoxes>},
    BoxSceneKind{"moving-5", "uniform boxes of which the same 5 % move", "boxes", 100'000,
                 makeBrownian<oneInSoManyMoves<20>>},
    BoxSceneKind{"moving-2", "uniform boxes of which the same 2 % move", "boxes", 100'000,
                 makeBrownian<oneInSoManyMoves<50>>},
    BoxSceneKind{"static-90", "uniform boxes of which 90 % are static and 10 % move", "boxes",
                 100'000, makeBrownian<mostlyStaticBoxes>},
    BoxSceneKind{"trembling", "uniform boxes that tremble by 1 cm about their places", "boxes",
                 30'000, makeNear<kTrembling>},
    BoxSceneKind{"creeping", "uniform boxes that creep, each by up to 2 mm an axis and frame",
                 "boxes", 30'000, makeNear<kCreeping>},
    BoxSceneKind{"breathing", "uniform boxes that grow and shrink by 1 cm", "boxes", 30'000,
                 makeNear<kBreathing>},
    BoxSceneKind{"mixed-2", "trembling boxes, through which 2 % travel", "boxes", 30'000,
                 makeNear<kMixed2>},
    BoxSceneKind{"mixed-20", "trembling boxes, through which 20 % travel", "boxes", 30'000,
                 makeNear<kMixed20>},
    BoxSceneKind{"terdiman", "Terdiman's box pruning scene, large integer boxes that drift",
                 "boxes", 10'000, makeBoxScene<TerdimanScene>},
    BoxSceneKind{"brownian", "Broadmark's Brownian scene, fast unit cubes that fill a tenth",
                 "boxes", 16'000, makeBrownian<broadmarkBoxes>},
};

}  // namespace

std::span<const BoxSceneKind> boxSceneKinds() {
    return kBoxScenes;
}

}  // namespace hashphase::demos
