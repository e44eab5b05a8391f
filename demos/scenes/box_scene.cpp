// SPDX-License-Identifier: Zlib
#include <demos/scenes/box_scene.hpp>

#include <demos/scenes/brownian_scene.hpp>
#include <demos/scenes/paper_scene.hpp>

#include <array>

namespace hashphase::demos {
namespace {

std::unique_ptr<BoxScene> makePaper(std::size_t objects, std::uint64_t seed) {
    return std::make_unique<PaperScene>(objects, seed);
}

template <BrownianBoxes (*scatter)(std::size_t, std::uint64_t)>
std::unique_ptr<BoxScene> makeBrownian(std::size_t objects, std::uint64_t seed) {
    return std::make_unique<BrownianScene>(scatter(objects, seed), seed);
}

constexpr std::array kKinds{
    BoxSceneKind{"paper", "spheres of radius 1 m roaming a random terrain of 400 x 400 m",
                 "spheres", 30'000, makePaper},
    BoxSceneKind{"uniform", "boxes of 0.5-1.5 m all over a cube, each overlapping about two others",
                 "boxes", 30'000, makeBrownian<uniformBoxes>},
    BoxSceneKind{"piles", "dense piles of 100 boxes, spread over 10 x 10 km", "boxes", 30'000,
                 makeBrownian<pileBoxes>},
    BoxSceneKind{"logsizes", "boxes of 0.1-30 m, as many of each order of magnitude", "boxes",
                 30'000, makeBrownian<logSizeBoxes>},
    BoxSceneKind{"resting", "uniform boxes of which the same 2 % move, 49 % rest, 49 % are static",
                 "boxes", 100'000, makeBrownian<restingBoxes>},
};

}  // namespace

std::span<const BoxSceneKind> boxSceneKinds() {
    return kKinds;
}

}  // namespace hashphase::demos
