// SPDX-License-Identifier: Zlib
#pragma once

// Ways to know what fast objects touch during a frame, between where they are when it begins and
// where they are when it ends.

#include <broadphase/moving_box.hpp>
#include <broadphase/sweep_mode.hpp>
#include <demos/compare/reference_pairs.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace hashphase::demos {

/// Objects of one frame. The first `movers` may move while it lasts; the others never do.
struct SweptFrame {
    std::vector<MovingBox<float>> objects;
    std::uint32_t movers = 0;

    /// By axis: all coordinates are multiples of it, at the start and at the end of the frame, and
    /// below 2^24 of them. So no coordinate is rounded.
    std::array<float, 3> unit{kUnit, kUnit, kUnit};  // [m]

    static constexpr float kUnit = 0x1p-10F;
};

/// What a frame cost, over all movers.
struct SweepWork {
    std::uint64_t cells = 0;  // visited
    std::uint64_t tests = 0;  // of two boxes, or a box and a way
};

/// One way at work on one scene.
class SweepFinder {
public:
    SweepFinder() = default;
    SweepFinder(const SweepFinder&) = delete;
    SweepFinder& operator=(const SweepFinder&) = delete;
    virtual ~SweepFinder() = default;

    /// A frame: takes the movers as they are now, and finds the pairs.
    virtual void step(const SweptFrame& frame) = 0;

    /// Appends the pairs that the last step left, in any order, those among others than movers too.
    virtual void listPairs(std::vector<PairKey>& pairs) const = 0;

    /// Of the last step, where that is counted.
    [[nodiscard]] virtual std::optional<SweepWork> work() const { return std::nullopt; }
};

enum class SweepOrigin : std::uint8_t { ours, paper, bullet };

struct SweepMethod {
    std::string name;
    SweepOrigin origin = SweepOrigin::ours;
    bool missesNothing = true;   // promises every pair that touches
    bool inventsNothing = true;  // promises that the pairs it lists touch
    bool isDiscrete = false;     // looks at the end of the frame alone

    /// Slow ones take part in every so manieth frame of many.
    int oneFrameIn = 1;

    /// When two objects touch first, of methods that say.
    std::function<std::optional<double>(const MovingBox<float>&, const MovingBox<float>&)>
        contactTime;

    std::function<std::unique_ptr<SweepFinder>(const SweptFrame& first)> make;

    [[nodiscard]] bool isExact() const noexcept { return missesNothing && inventsNothing; }
};

/// All of them: ours, those on the paper's grid, Bullet's.
[[nodiscard]] std::vector<SweepMethod> sweepMethods();

/// Grid, Sweeps and Pairs. With Sweep::none it knows the boxes at the end of the frame, as every
/// broadphase does that knows nothing of motion.
[[nodiscard]] SweepMethod gridSweep(Sweep sweep);

/// The paper's hashing over time, on its grid of columns over the ground. As the paper has it, what
/// shares a cell counts, if the boxes around the ways overlap.
[[nodiscard]] SweepMethod paperBox();
[[nodiscard]] SweepMethod paperLine();

/// The same grid, with all columns that the thick way touches, and firstContact().
[[nodiscard]] SweepMethod thickLine();

/// btDbvtBroadphase: the boxes at the end of the frame, without the pairs that it keeps though they
/// have come apart, in which the narrowphase finds nothing; the boxes around the ways, as m_useContinuous
/// has it; and these with firstContact() for every pair that is listed.
enum class BulletSweep : std::uint8_t { discrete, united, unitedAndTested };
[[nodiscard]] SweepMethod bulletSweep(BulletSweep sweep);

/// The box at the end of the frame.
[[nodiscard]] inline Aabb<float> endBox(const MovingBox<float>& moving) {
    return moving.box.translated(moving.displacement);
}

/// The box around the way. Nothing is rounded in the scenes of this experiment.
[[nodiscard]] inline Aabb<float> wayBox(const MovingBox<float>& moving) {
    return moving.box.merged(endBox(moving));
}

}  // namespace hashphase::demos
