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

    void setMode(CameraMode mode);
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
    void keepWithinLimits() { setState(mode_, state()); }
    [[nodiscard]] float reach() const;

    CameraMode mode_ = CameraMode::top;
    Aabb<float> bounds_;
    // From above.
    Vector3<float> centre_ = Vector3<float>::Zero();
    float height_ = 100;
    float topYaw_ = 0;
    // Free.
    Vector3<float> eye_ = Vector3<float>::Zero();
    float yaw_ = 0;
    float pitch_ = 0;
    // Following.
    Vector3<float> target_ = Vector3<float>::Zero();
    float distance_ = 20;
    float followYaw_ = 0;
    float followPitch_ = -0.4F;
};

}  // namespace hashphase::demos
