// SPDX-License-Identifier: Zlib
#include <demos/paper/bounding_volumes.hpp>

#include <broadphase/neighbours.hpp>
#include <demos/console/format.hpp>
#include <demos/report/frame_clock.hpp>
#include <demos/report/stopwatch.hpp>

#include <algorithm>
#include <memory>

namespace hashphase::demos {
namespace {

constexpr std::array kVolumeKinds{VolumeKind::sphere, VolumeKind::aabb, VolumeKind::obb};

using StickPair = std::array<std::uint32_t, 2>;

class VolumePass {
public:
    VolumePass(VolumeKind kind, std::span<const Stick> sticks) : kind_(kind) {
        for (const Stick& stick : sticks) {
            ids_.push_back(grid_.add(boxOf(kind, stick)));
        }
    }

    void findCandidates(std::span<const Stick> sticks) {
        for (std::size_t i = 0; i < sticks.size(); ++i) {
            grid_.move(ids_[i], boxOf(kind_, sticks[i]));
        }
        grid_.update();
        passed_.clear();
        const std::span<const ProxyPair> candidates = neighbours_.find(grid_, 0);
        candidates_ = candidates.size();
        for (const auto& [a, b] : candidates) {
            if (volumesOverlap(kind_, sticks[a.index], sticks[b.index])) {
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

    [[nodiscard]] std::size_t candidates() const { return candidates_; }
    [[nodiscard]] std::size_t passed() const { return passed_.size(); }
    [[nodiscard]] std::vector<StickPair> touching() const {
        std::vector<StickPair> sorted = touching_;
        std::sort(sorted.begin(), sorted.end());
        return sorted;
    }

private:
    VolumeKind kind_;
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
            if (volumesOverlap(VolumeKind::sphere, sticks[a], sticks[b]) &&
                sticksTouch(sticks[a], sticks[b])) {
                pairs.push_back({a, b});
            }
        }
    }
    return pairs;
}

void runVolumeFrame(VolumePass& pass, std::span<const Stick> sticks, VolumeResult& result) {
    const FrameClock firstPass;
    pass.findCandidates(sticks);
    result.firstPassMs.push_back(firstPass.milliseconds());
    const FrameClock exact;
    pass.testExactly(sticks);
    result.exactMs.push_back(exact.milliseconds());
    result.candidates += static_cast<double>(pass.candidates());
    result.passed += static_cast<double>(pass.passed());
    result.touching += static_cast<double>(pass.touching().size());
}

/// With one pass for each kind, which are made.
PaperCheck compareVolumes(std::span<const Stick> sticks,
                          std::vector<std::unique_ptr<VolumePass>>& passes) {
    const std::vector<StickPair> right = touchingByBruteForce(sticks);
    std::string faults;
    for (const VolumeKind kind : kVolumeKinds) {
        passes.push_back(std::make_unique<VolumePass>(kind, sticks));
        passes.back()->findCandidates(sticks);
        passes.back()->testExactly(sticks);
        if (passes.back()->touching() != right) {
            faults += " " + std::string(nameOf(kind));
        }
    }
    return {"Whatever the bounding volume, the same sticks touch",
            faults.empty() ? CheckOutcome::holds : CheckOutcome::broken,
            faults.empty() ? withThousands(right.size()) + " pairs touch" : "wrong with" + faults};
}

}  // namespace

std::string_view nameOf(VolumeKind kind) {
    constexpr std::array<std::string_view, 3> kNames{"sphere", "AABB", "OBB"};
    return kNames[static_cast<std::size_t>(kind)];
}

VolumeResults measureVolumes(std::uint32_t sticks, const PhaseEffort& effort, std::uint64_t seed,
                             const IsTimeUp& isTimeUp) {
    StickScene scene(sticks, seed);
    VolumeResults results;
    results.sticks = sticks;
    std::vector<std::unique_ptr<VolumePass>> passes;
    results.checks.push_back(compareVolumes(scene.sticks(), passes));
    for (const VolumeKind kind : kVolumeKinds) {
        results.volumes.push_back({kind, {}, {}, 0, 0, 0});
    }
    const double budget = effort.methodMilliseconds * static_cast<double>(passes.size());
    const Stopwatch watch;
    const auto goesOn = [&] {
        return results.frames < effort.fewestFrames ||
               (results.frames < effort.frames && watch.milliseconds() < budget);
    };
    for (; goesOn() && !isTimeUp(); ++results.frames) {
        scene.advance();
        for (std::size_t turn = 0; turn < passes.size(); ++turn) {
            const std::size_t i = (turn + results.frames) % passes.size();
            runVolumeFrame(*passes[i], scene.sticks(), results.volumes[i]);
        }
    }
    if (results.frames == 0) {
        results.volumes.clear();
    }
    for (VolumeResult& each : results.volumes) {
        each.candidates /= results.frames;
        each.passed /= results.frames;
        each.touching /= results.frames;
    }
    return results;
}

}  // namespace hashphase::demos
