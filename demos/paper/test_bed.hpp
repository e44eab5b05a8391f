// SPDX-License-Identifier: Zlib
#pragma once

// The test bed of the paper, frame by frame: its spheres, its terrain as triangles, a camera over
// it, and colours. All methods see the same frame; none changes it.
//
// Domain      400 x 400 up to 50,000 objects; beyond, as much larger as keeps their density.
// Repeatable  Frame n depends on the number of objects, the seed and n alone.
// Units       metres, seconds

#include <demos/scenes/camera_view.hpp>
#include <demos/scenes/paper_scene.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace hashphase::demos {

class TestBed {
public:
    static constexpr std::uint32_t kColours = 6;

    TestBed(std::uint32_t objects, std::uint64_t seed);

    /// Moves to the next frame.
    void advance();

    /// What all boxes of all frames are in, the ground too.
    [[nodiscard]] Aabb<float> domain() const { return scene_.bounds(); }
    [[nodiscard]] float side() const { return side_; }  // [m]

    [[nodiscard]] std::uint32_t objects() const {
        return static_cast<std::uint32_t>(scene_.boxes().size());
    }
    [[nodiscard]] const std::vector<Aabb<float>>& boxes() const { return scene_.boxes(); }
    [[nodiscard]] std::span<const Vector3<float>> centres() const { return centres_; }
    [[nodiscard]] std::span<const Vector3<float>> velocities() const { return velocities_; }

    /// With which the AI of every frame begins.
    [[nodiscard]] std::span<const std::uint32_t> colours() const { return colours_; }

    /// Of a camera in the middle of the domain that turns on the spot.
    [[nodiscard]] const CameraView& view() const { return view_; }
    [[nodiscard]] const TriangleGround& ground() const { return ground_; }

private:
    float side_;
    PaperScene scene_;
    TriangleGround ground_;
    std::vector<Vector3<float>> centres_;
    std::vector<Vector3<float>> velocities_;
    std::vector<std::uint32_t> colours_;
    CameraView view_;
    std::uint32_t frame_ = 0;
};

}  // namespace hashphase::demos
