// SPDX-License-Identifier: Zlib
//
// Overlap of oriented boxes and distance of segments: C. Ericson, "Real-Time Collision Detection",
// 2005, sections 4.4.1 and 5.1.9.

#include <demos/paper/phase_measurement.hpp>

#include <broadphase/neighbours.hpp>
#include <demos/report/frame_clock.hpp>
#include <demos/report/stopwatch.hpp>
#include <demos/scenes/random.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

namespace hashphase::demos {
namespace {

// --- Sticks ---------------------------------------------------------------------------------------

/// A capsule.
struct Stick {
    static constexpr float kHalfLength = 1.8F;  // of the line within [m]
    static constexpr float kRadius = 0.2F;      // [m]

    Vector3<float> centre;
    std::array<Vector3<float>, 3> axes;  // at right angles, the first one along the stick
    Vector3<float> turnsAbout;
};

Vector3<float> randomDirection(Random& random) {
    Vector3<float> direction;
    do {
        direction = {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    } while (direction.squaredNorm() > 1 || direction.squaredNorm() < 0.01F);
    return direction.normalized();
}

/// In a cube with 30 m^3 for each.
std::vector<Stick> randomSticks(std::uint32_t count, std::uint64_t seed) {
    constexpr float kVolumeOfEach = 30;
    Random random(seed);
    const float edge = std::cbrt(kVolumeOfEach * static_cast<float>(count));
    std::vector<Stick> sticks(count);
    for (Stick& stick : sticks) {
        stick.centre = {random.between(0, edge), random.between(0, edge), random.between(0, edge)};
        stick.axes[0] = randomDirection(random);
        stick.axes[1] = stick.axes[0].unitOrthogonal();
        stick.axes[2] = stick.axes[0].cross(stick.axes[1]);
        stick.turnsAbout = randomDirection(random);
    }
    return sticks;
}

void turn(std::vector<Stick>& sticks) {
    constexpr float kTurnOfFrame = 0.05F;  // [rad]
    for (Stick& stick : sticks) {
        const Eigen::AngleAxis<float> turn(kTurnOfFrame, stick.turnsAbout);
        for (Vector3<float>& axis : stick.axes) {
            axis = turn * axis;
        }
    }
}

/// Whether the sticks touch: the exact test.
bool sticksTouch(const Stick& a, const Stick& b) {
    const Vector3<float>& u = a.axes[0];
    const Vector3<float>& v = b.axes[0];
    const Vector3<float> between = a.centre - b.centre;
    const auto within = [](float along) {
        return std::clamp(along, -Stick::kHalfLength, Stick::kHalfLength);
    };
    const float cosine = u.dot(v);
    const float alongU = u.dot(between);
    const float alongV = v.dot(between);
    const float sineSquared = 1 - cosine * cosine;
    // The nearest point of the first line; then of the second segment to it, and back.
    float s = sineSquared > 1e-6F ? within((cosine * alongV - alongU) / sineSquared) : 0;
    const float t = within(cosine * s + alongV);
    s = within(cosine * t - alongU);
    constexpr float kTouching = 2 * Stick::kRadius;
    return (between + s * u - t * v).squaredNorm() <= kTouching * kTouching;
}

// --- Volumes --------------------------------------------------------------------------------------

// They are larger than the stick by a rounding error, so that none leaves out what touches.

constexpr float kRounding = 1e-3F;  // [m]
constexpr float kReach = Stick::kHalfLength + Stick::kRadius + kRounding;
constexpr std::array kHalfExtents{kReach, Stick::kRadius + kRounding, Stick::kRadius + kRounding};

float halfAlong(const Stick& stick, const Vector3<float>& direction) {
    float half = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        half += kHalfExtents[i] * std::abs(stick.axes[i].dot(direction));
    }
    return half;
}

bool isBetween(const Stick& a, const Stick& b, const Vector3<float>& direction) {
    return std::abs((b.centre - a.centre).dot(direction)) >
           halfAlong(a, direction) + halfAlong(b, direction);
}

bool orientedBoxesOverlap(const Stick& a, const Stick& b) {
    for (std::size_t i = 0; i < 3; ++i) {
        if (isBetween(a, b, a.axes[i]) || isBetween(a, b, b.axes[i])) {
            return false;
        }
    }
    for (const Vector3<float>& u : a.axes) {
        for (const Vector3<float>& v : b.axes) {
            // Parallel edges give no direction of their own.
            const Vector3<float> across = u.cross(v);
            if (across.squaredNorm() > 1e-6F && isBetween(a, b, across)) {
                return false;
            }
        }
    }
    return true;
}

Vector3<float> halfOfSphere(const Stick& /*stick*/) {
    return Vector3<float>::Constant(kReach);
}

Vector3<float> halfOfAabb(const Stick& stick) {
    return Stick::kHalfLength * stick.axes[0].cwiseAbs() +
           Vector3<float>::Constant(Stick::kRadius + kRounding);
}

Vector3<float> halfOfOrientedBox(const Stick& stick) {
    return {halfAlong(stick, Vector3<float>::UnitX()), halfAlong(stick, Vector3<float>::UnitY()),
            halfAlong(stick, Vector3<float>::UnitZ())};
}

bool spheresOverlap(const Stick& a, const Stick& b) {
    return (b.centre - a.centre).squaredNorm() <= 4 * kReach * kReach;
}

/// A kind of volume around a stick. Half the sides of its box, which is filed; and whether two whose boxes
/// overlap do themselves.
struct Volume {
    const char* name;
    Vector3<float> (*half)(const Stick&);
    bool (*overlap)(const Stick&, const Stick&);
};

constexpr std::array kVolumes{
    Volume{"sphere", halfOfSphere, spheresOverlap},
    Volume{"AABB", halfOfAabb, [](const Stick&, const Stick&) { return true; }},
    Volume{"OBB", halfOfOrientedBox, orientedBoxesOverlap}};

// --- Passes ---------------------------------------------------------------------------------------

using StickPair = std::array<std::uint32_t, 2>;

class VolumePass {
public:
    VolumePass(const Volume& volume, std::span<const Stick> sticks) : volume_(volume) {
        for (const Stick& stick : sticks) {
            ids_.push_back(grid_.add(boxOf(stick)));
        }
    }

    void findCandidates(std::span<const Stick> sticks) {
        for (std::size_t i = 0; i < sticks.size(); ++i) {
            grid_.move(ids_[i], boxOf(sticks[i]));
        }
        grid_.update();
        passed_.clear();
        const std::span<const ProxyPair> candidates = neighbours_.find(grid_, 0);
        candidates_ = candidates.size();
        for (const auto& [a, b] : candidates) {
            if (volume_.overlap(sticks[a.index], sticks[b.index])) {
                passed_.push_back({a.index, b.index});
            }
        }
    }

    void testExactly(std::span<const Stick> sticks) {
        touching_.clear();
        for (const StickPair& pair : passed_) {
            if (sticksTouch(sticks[pair[0]], sticks[pair[1]])) {
                touching_.push_back(pair);
            }
        }
    }

    void compare(std::span<const Stick> sticks, const std::vector<StickPair>& right,
                 Measurements& measured) {
        findCandidates(sticks);
        testExactly(sticks);
        std::sort(touching_.begin(), touching_.end());
        measured.add(
            "volume_checks",
            {{"volume", volume_.name}, {"pairs", right.size()}, {"is_right", touching_ == right}});
    }

    void measureFrame(std::uint32_t frame, std::span<const Stick> sticks, Measurements& measured) {
        const FrameClock clock;
        findCandidates(sticks);
        const double firstPass = clock.milliseconds();
        const FrameClock exact;
        testExactly(sticks);
        measured.add("volumes", {{"volume", volume_.name},
                                 {"frame", frame},
                                 {"candidates", candidates_},
                                 {"passed", passed_.size()},
                                 {"touching", touching_.size()},
                                 {"first_ms", firstPass},
                                 {"exact_ms", exact.milliseconds()}});
    }

private:
    [[nodiscard]] Aabb<float> boxOf(const Stick& stick) const {
        const Vector3<float> half = volume_.half(stick);
        return {stick.centre - half, stick.centre + half};
    }

    const Volume& volume_;
    Grid<float> grid_;
    Neighbours<float> neighbours_;
    std::vector<ProxyId> ids_;
    std::size_t candidates_ = 0;
    std::vector<StickPair> passed_;
    std::vector<StickPair> touching_;
};

std::vector<StickPair> touchingByBruteForce(std::span<const Stick> sticks) {
    std::vector<StickPair> pairs;
    for (std::uint32_t a = 0; a < sticks.size(); ++a) {
        for (std::uint32_t b = a + 1; b < sticks.size(); ++b) {
            if (spheresOverlap(sticks[a], sticks[b]) && sticksTouch(sticks[a], sticks[b])) {
                pairs.push_back({a, b});
            }
        }
    }
    return pairs;
}

}  // namespace

void measureVolumes(std::uint32_t count, const PhaseEffort& effort, std::uint64_t seed,
                    Measurements& measured, const IsTimeUp& isTimeUp) {
    std::vector<Stick> sticks = randomSticks(count, seed);
    const std::vector<StickPair> right = touchingByBruteForce(sticks);
    std::vector<std::unique_ptr<VolumePass>> passes;
    for (const Volume& volume : kVolumes) {
        passes.push_back(std::make_unique<VolumePass>(volume, sticks));
        passes.back()->compare(sticks, right, measured);
    }
    const double budget = effort.methodMilliseconds * static_cast<double>(passes.size());
    const Stopwatch watch;
    for (std::uint32_t frame = 0; frame < effort.frames && !isTimeUp(); ++frame) {
        if (frame >= effort.fewestFrames && watch.milliseconds() >= budget) {
            break;
        }
        turn(sticks);
        for (std::size_t turn = 0; turn < passes.size(); ++turn) {
            passes[(turn + frame) % passes.size()]->measureFrame(frame, sticks, measured);
        }
    }
}

}  // namespace hashphase::demos
