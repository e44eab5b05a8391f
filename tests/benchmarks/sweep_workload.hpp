// SPDX-License-Identifier: Zlib
#pragma once

// Some of the objects move so far in a frame that it matters what they pass: which pairs touch at the
// same time?
//
// Motions   In every frame the sweeping ones are where the scene has them when the frame begins, and
//           move from there, each in a direction of its own.
// Bullet    has no such question. Where its broadphases are told of continuous motion, they are given
//           the box around the start and the end; so they are here.

#include <tests/benchmarks/pair_workload.hpp>

#include <broadphase/moving_box.hpp>

#include <array>

namespace hashphase::benchmarks {

class SweepWorkload : public PairWorkload {
public:
    /// Every 30th object moves by so many cells a frame: the finest cells that a grid chooses for the
    /// scene as it begins.
    SweepWorkload(std::unique_ptr<demos::BoxScene> scene, float cells, std::uint64_t seed);

    void beginFrame() override;
    void listExactAnswers(std::vector<Answer>& answers) override;

private:
    /// The boxes around a way's parts, of equal time.
    using Parts = std::array<Aabb<float>, 16>;

    [[nodiscard]] FrameBoxes frameFor(const ContestantKind& kind) const override;
    [[nodiscard]] bool touch(std::uint32_t a, std::uint32_t b) const;

    std::vector<ObjectMotion> motions_;

    // By object, of the present frame.
    std::vector<MovingBox<float>> moving_;
    std::vector<Aabb<float>> ways_;             // the boxes around them
    std::vector<demos::BulletBox> bulletWays_;  // the same

    std::vector<Parts> parts_;  // by motion
};

}  // namespace hashphase::benchmarks
