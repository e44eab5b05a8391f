// SPDX-License-Identifier: Zlib
#pragma once

// The camera of the viewer: it looks down on all, flies where it is steered, or follows a body.
//
// Units  metres, radians

#include <demos/scenes/camera_view.hpp>

#include <broadphase/aabb.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace hashphase::demos {

enum class CameraMode : std::uint8_t { top, free, follow };

inline constexpr std::array<std::string_view, 3> kCameraModes{"top", "free", "follow"};

class Camera {
public:
    /// Stands where all of the bounds is to be seen, in each mode.
    void goHome(const Aabb<float>& bounds);

    /// Stays where it is, in a scene of these bounds.
    void setBounds(const Aabb<float>& bounds) { bounds_ = bounds; }

    void setMode(CameraMode mode) { mode_ = mode; }
    [[nodiscard]] CameraMode mode() const noexcept { return mode_; }

    /// To the right, up and forward, as it looks; a camera that looks down goes over the ground. One that
    /// follows does not move.
    void move(const Vector3<float>& way);

    /// To the left and up. Over the top it does not go; one that looks down turns around itself.
    void turn(float yaw, float pitch);

    /// Nearer to what it looks at by that factor, above 1, or farther away.
    void zoom(float factor);

    /// Stands there at once, and is free.
    void place(const Vector3<float>& eye, float yaw, float pitch);

    /// Where the body that it follows is now.
    void setTarget(const Vector3<float>& target);

    [[nodiscard]] CameraPose pose(double aspect) const;

    /// All that the camera remembers, but for its bounds: in each mode.
    static constexpr std::size_t kStateSize = 16;
    using State = std::array<float, kStateSize>;
    [[nodiscard]] State state() const;
    void setState(CameraMode mode, const State& wanted);

    /// The least and the most that each number of a state can be. Whatever would take the camera beyond takes
    /// it there; after half a turn headings go on from the other side.
    struct Limits {
        float low;
        float high;
    };
    [[nodiscard]] static std::span<const Limits, kStateSize> stateLimits();

private:
    /// What a mode remembers. From above, `at` is what lies below, and there is no pitch; free, it is the eye,
    /// and there is no distance; else it is the body that is followed.
    struct Stand {
        Vector3<float> at = Vector3<float>::Zero();
        float distance = 0;
        float yaw = 0;
        float pitch = 0;
    };

    [[nodiscard]] Stand& stand() { return stands_[static_cast<std::size_t>(mode_)]; }
    [[nodiscard]] std::array<float*, kStateSize> numbers();
    void keepWithinLimits() { setState(mode_, state()); }

    CameraMode mode_ = CameraMode::free;
    Aabb<float> bounds_;
    std::array<Stand, kCameraModes.size()> stands_;
};

}  // namespace hashphase::demos
