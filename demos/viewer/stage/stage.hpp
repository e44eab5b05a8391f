// SPDX-License-Identifier: Zlib
#pragma once

// A scene that runs and can be looked at: bodies that move, the grid that knows where they are, whoever
// finds their pairs, and what looks at them (culling, picking, proximity). The viewer knows all scenes by
// this, whoever moves the bodies: the library's own simulation, Bullet, or a recording.
//
// Bodies   are named by an index, that of their proxy in the grid; indices of who was removed are used again.
// Frames   of 1/60 s; what happens depends on the scene, the seed and the calls alone.
// Errors   A declaration that cannot be run throws std::invalid_argument with a sentence.
// Threads  one at a time
// Units    metres, seconds

#include <demos/compare/broadphase_kind.hpp>
#include <demos/compare/reference_pairs.hpp>
#include <demos/report/profile_zones.hpp>
#include <demos/viewer/stage/phases.hpp>

#include <integration/effects/observers.hpp>

#include <Eigen/Geometry>

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {

inline constexpr float kFrameSeconds = 1.0F / 60;

/// What a body looks like, and what it does.
struct StageBody {
    enum class Shape : std::uint8_t { none, sphere, box, capsule };  // none: nobody, or not drawn

    Shape shape = Shape::none;
    Vector3<float> centre = Vector3<float>::Zero();
    Eigen::Quaternionf orientation = Eigen::Quaternionf::Identity();
    /// Of a box its half extents; of a sphere its radius, in x; of a capsule its radius in x and, from
    /// the middle to the centre of an end, in y.
    Vector3<float> size = Vector3<float>::Zero();
    float speed = 0;
    bool isStatic = false;
    bool isAsleep = false;
};

/// Where the way from a point first meets the body, as a share of the way: 0 where it begins inside, nothing
/// where it does not.
[[nodiscard]] std::optional<float> meets(const StageBody& body, const Vector3<float>& from,
                                         const Vector3<float>& way);

/// The same of triangles, three corners each, from either side. Cost: O(triangles).
[[nodiscard]] std::optional<float> meets(std::span<const Vector3<float>> triangles,
                                         const Vector3<float>& from, const Vector3<float>& way);

/// The box around it.
[[nodiscard]] Aabb<float> boxAround(const StageBody& body);

/// Those effects, each with its defaults.
[[nodiscard]] SceneEffects effectsOf(EffectSet effects);

/// The box of nobody.
[[nodiscard]] inline Aabb<float> nowhere() {
    const Vector3<float> corner = Vector3<float>::Constant(std::numeric_limits<float>::quiet_NaN());
    return {corner, corner};
}

/// The box and this much around it, on each side [m].
[[nodiscard]] inline Aabb<float> withRoom(const Aabb<float>& box, const Vector3<float>& room) {
    return {box.min() - room, box.max() + room};
}

/// The way on which something fast has passed through a wall in a frame.
struct TunnelMark {
    Vector3<float> from;
    Vector3<float> to;
    std::uint64_t frame = 0;
};

/// A ball that knows who is in it.
struct InterestZone {
    Vector3<float> centre;
    float radius = 0;
    std::size_t bodyCount = 0;  // whose middles were in it in the last frame
};

/// How many bodies were where, in columns along x and rows along z, at all heights together.
struct RadarView {
    Eigen::Vector2f corner;  // of the first column and row: their least x and z [m]
    float cellSize = 0;
    std::uint32_t columns = 0;
    std::uint32_t rows = 0;
    std::uint32_t groupCount = 0;
    std::span<const std::uint32_t> counts;  // as [group][row][column], until the next frame
};

class Stage {
public:
    virtual ~Stage() = default;

    /// Simulates one frame of what is declared.
    void step();

    // --- Who is there ----------------------------------------------------------------------------

    [[nodiscard]] virtual std::size_t size() const = 0;
    /// Every body's index is below it.
    [[nodiscard]] virtual std::uint32_t indexLimit() const = 0;
    [[nodiscard]] virtual StageBody body(std::uint32_t index) const = 0;
    [[nodiscard]] bool contains(std::uint32_t index) const {
        return body(index).shape != StageBody::Shape::none;
    }

    /// Takes bodies out, with their pairs, and returns how many; none of a recording, or of who is not there.
    std::size_t remove(std::span<const std::uint32_t> indices);
    /// Gives the body another velocity as well as its own. False where that cannot be, as above.
    virtual bool push(std::uint32_t /*index*/, const Vector3<float>& /*velocity*/) { return false; }

    /// Corners of triangles, three each; valid while the stage lives.
    [[nodiscard]] virtual std::span<const Vector3<float>> ground() const { return {}; }

    /// Where bodies are to begin with, or may be.
    [[nodiscard]] const Aabb<float>& bounds() const noexcept { return bounds_; }

    /// Those of the last frames; and how many there have been in all.
    [[nodiscard]] std::span<const TunnelMark> tunnelMarks() const noexcept { return tunnelMarks_; }
    [[nodiscard]] std::uint64_t tunnelCount() const noexcept { return tunnelCount_; }

    /// The same number where all bodies are at the same places, to the last bit.
    [[nodiscard]] virtual std::uint64_t placesHash() const = 0;

    // --- What runs -------------------------------------------------------------------------------

    [[nodiscard]] const SceneEffects& effects() const noexcept { return effects_; }
    /// Goes on with another declaration. Where it throws, nothing has changed.
    void declare(const SceneEffects& effects);

    /// The effects that this scene can run.
    [[nodiscard]] EffectSet possibleEffects() const noexcept { return possibleEffects_; }

    /// Who finds the pairs from the next frame on.
    void setBroadphase(const BroadphaseKind& kind);
    [[nodiscard]] const BroadphaseKind& broadphase() const noexcept { return *broadphase_; }

    /// As the broadphase has found them in the last frame, of who is still there, by indices, sorted; none while
    /// they are not declared. After a declaration or with another broadphase they are wrong until the next frame.
    virtual void listPairs(std::vector<PairKey>& pairs) const = 0;
    /// How many these are. Cost: O(1).
    [[nodiscard]] virtual std::size_t pairCount() const = 0;

    /// What it was given: by index; nowhere() for who is not there. `filters` stays empty where all may pair.
    virtual void listBoxes(std::vector<Aabb<float>>& boxes,
                           std::vector<CollisionFilter>& filters) const = 0;

    /// The grid of all bodies; null while no effect asks one.
    [[nodiscard]] virtual const Grid<float>* grid() const = 0;
    [[nodiscard]] Observers<float>& observers() noexcept { return *observers_; }
    [[nodiscard]] const Observers<float>& observers() const noexcept { return *observers_; }

    /// The nearest body that the ray meets, as it is drawn, before it comes to the ground. Needs picking.
    /// Cost: that of the query, and a look at each triangle of the ground.
    [[nodiscard]] Picked<float> pick(const RayRegion<float>& ray);

    /// The scene's zones; none while they are not declared.
    [[nodiscard]] std::span<const InterestZone> interestZones() const noexcept {
        return interestZones_;
    }

    /// What the radar saw when it last looked: around the observers' interest, along the axes. Nothing before
    /// its first frame, while it is not declared, and where y is not up for it.
    [[nodiscard]] const std::optional<RadarView>& radar() const noexcept { return radar_; }

    // --- What it took ----------------------------------------------------------------------------

    /// The phases of the last frame.
    [[nodiscard]] std::span<const PhaseTime> times() const noexcept { return clock_.times(); }

    /// Bullet's own profile zones of the last frame, outer ones before inner ones; none where Bullet does
    /// not run.
    [[nodiscard]] std::span<const ProfileZone> zones() const noexcept { return zones_; }

    /// Of all tables; nothing where the heap does not tell what Bullet's broadphase holds.
    [[nodiscard]] virtual std::optional<std::int64_t> memoryBytes() const = 0;

protected:
    /// Declared from the beginning; and what can be.
    Stage(const SceneEffects& effects, EffectSet possible)
        : effects_(effects), possibleEffects_(possible) {}

    /// Simulates one frame and has it observed.
    virtual void runFrame() = 0;
    /// Says in a sentence why the declaration cannot be run; empty when it can.
    [[nodiscard]] virtual std::string faultOf(const SceneEffects& effects) const = 0;
    /// Goes on with effects(), which have no fault, after those before.
    virtual void follow(const SceneEffects& before) = 0;
    /// Goes on with another broadphase than broadphase(), or throws std::invalid_argument.
    virtual void useBroadphase(const BroadphaseKind& kind) = 0;
    /// False where nobody has the index, or who has it cannot be removed.
    virtual bool removeOne(std::uint32_t /*index*/) { return false; }
    /// Bodies have been removed.
    virtual void forgetRemoved() {}

    /// The sum of both, where the other is known.
    [[nodiscard]] static std::optional<std::int64_t> sumOf(std::size_t own,
                                                           std::optional<std::int64_t> other) {
        return other ? std::optional(static_cast<std::int64_t>(own) + *other) : std::nullopt;
    }

    Observers<float>* observers_ = nullptr;  // those of the one who derives
    Aabb<float> bounds_;
    std::vector<TunnelMark> tunnelMarks_;
    std::uint64_t tunnelCount_ = 0;
    std::vector<ProfileZone> zones_;
    PhaseClock clock_;

private:
    /// Gives agents their first colours: the same, whoever runs the scene.
    void colourAgents();

    void noteZones();
    void noteRadar();

    SceneEffects effects_;
    EffectSet possibleEffects_;
    const BroadphaseKind* broadphase_ = &broadphaseKinds().front();
    std::vector<InterestZone> interestZones_;
    std::optional<RadarView> radar_;
};

}  // namespace hashphase::demos
