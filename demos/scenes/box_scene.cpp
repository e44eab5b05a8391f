// SPDX-License-Identifier: Zlib
#include <demos/scenes/box_scene.hpp>

#include <demos/scenes/brownian_scene.hpp>
#include <demos/scenes/paper_scene.hpp>
#include <demos/scenes/terdiman_scene.hpp>

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

template <std::size_t period>
BrownianBoxes oneInSoManyMoves(std::size_t objects, std::uint64_t seed) {
    return someMovingBoxes(objects, seed, period);
}

std::unique_ptr<BoxScene> makeTerdiman(std::size_t objects, std::uint64_t seed) {
    return std::make_unique<TerdimanScene>(objects, seed);
}

constexpr std::array kBoxScenes{
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
    BoxSceneKind{"moving-5", "uniform boxes of which the same 5 % move", "boxes", 100'000,
                 makeBrownian<oneInSoManyMoves<20>>},
    BoxSceneKind{"moving-2", "uniform boxes of which the same 2 % move", "boxes", 100'000,
                 makeBrownian<oneInSoManyMoves<50>>},
    BoxSceneKind{"static-90", "uniform boxes of which 90 % are static and 10 % move", "boxes",
                 100'000, makeBrownian<mostlyStaticBoxes>},
    BoxSceneKind{"terdiman", "Terdiman's box pruning scene, large integer boxes that drift",
                 "boxes", 10'000, makeTerdiman},
    BoxSceneKind{"brownian", "Broadmark's Brownian scene, fast unit cubes that fill a tenth",
                 "boxes", 16'000, makeBrownian<broadmarkBoxes>},
};

}  // namespace

std::span<const BoxSceneKind> boxSceneKinds() {
    return kBoxScenes;
}

}  // namespace hashphase::demos
