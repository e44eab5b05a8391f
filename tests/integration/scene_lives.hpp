// SPDX-License-Identifier: Zlib
#pragma once

// Lives of boxes in all scenes, in which clients of a grid are asked.

#include <tests/support/box_scenes.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/query_checks.hpp>
#include <tests/support/script.hpp>

#include <gtest/gtest.h>

#include <cstdint>

namespace hashphase::test {

/// Calls ask(grid, script, frame) in each frame of a life in each scene; two frames of three are filed.
/// Stops when anything has failed.
template <class Scalar, class Ask>
void playAllScenes(std::uint64_t seed, int frames, const Ask& ask, const GridConfig& config = {}) {
    const CaughtMessages aboutNan;
    for (const BoxScene<Scalar>& scene : allBoxScenes<Scalar>()) {
        GridWorld<Scalar> world(config);
        Script<Scalar> script(scene, seed);
        script.begin(world);
        for (int frame = 0; frame < frames && !testing::Test::HasFailure(); ++frame) {
            SCOPED_TRACE(testing::Message()
                         << scene.name << ", frame " << frame << ", cell size " << config.cellSize);
            ask(world.grid, script, frame);
            if (frame % 3 != 1) {
                world.grid.update();
            }
            script.playFrame(world);
        }
    }
}

}  // namespace hashphase::test
