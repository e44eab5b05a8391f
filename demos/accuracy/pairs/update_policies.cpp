// SPDX-License-Identifier: Zlib
#include <demos/accuracy/pairs/pair_experiments.hpp>

#include <algorithm>
#include <utility>

namespace hashphase::demos {
namespace {

constexpr std::string_view kUpdateDeclaration =
#include <demos/accuracy/pairs/pairs.sql>

#include <demos/accuracy/pairs/update_policies.sql>
    ;

// --- Policies -------------------------------------------------------------------------------------

enum class FalsePairs {
    kKept,     // what overlaps by the fat boxes is listed
    kRefused,  // every listed pair is tested by the boxes as they are
};

bool contains(const BulletBox& outer, const BulletBox& inner) {
    bool isInside = true;
    for (int axis = 0; axis < 3; ++axis) {
        isInside &= (outer.min[axis] <= inner.min[axis]) & (inner.max[axis] <= outer.max[axis]);
    }
    return isInside;
}

BulletBox grown(const BulletBox& box, btScalar margin) {
    const btVector3 by(margin, margin, margin);
    return {box.min - by, box.max + by};
}

/// Sets a box only when the object has left the one that is grown by the margin.
class FatSource {
public:
    FatSource(btScalar margin, FalsePairs falsePairs, const BroadphaseNeeds& needs,
              std::span<const BulletBox> boxes)
        : margin_(margin), falsePairs_(falsePairs), filled_(broadphaseKind("hash"), needs) {
        for (const BulletBox& box : boxes) {
            const auto object = static_cast<std::uint32_t>(fat_.size());
            fat_.push_back(grown(box, margin));
            filled_.create(object, fat_.back(), {});
        }
    }

    void step(std::span<const BulletBox> boxes) {
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            if (!contains(fat_[i], boxes[i])) {
                fat_[i] = grown(boxes[i], margin_);
                filled_.set(static_cast<std::uint32_t>(i), fat_[i]);
            }
        }
        filled_.findPairs();
        if (falsePairs_ == FalsePairs::kRefused) {
            keepTrue(boxes);
        }
    }

    void listPairs(std::vector<PairKey>& pairs) const {
        if (falsePairs_ == FalsePairs::kKept) {
            filled_.listPairs(pairs);
            return;
        }
        pairs = true_;
        std::sort(pairs.begin(), pairs.end());
    }

private:
    /// As a narrowphase would, pair by pair in the cache's order.
    void keepTrue(std::span<const BulletBox> boxes) {
        true_.clear();
        btOverlappingPairCache& cache = *filled_.broadphase().getOverlappingPairCache();
        const int count = cache.getNumOverlappingPairs();
        const btBroadphasePair* listed = count > 0 ? cache.getOverlappingPairArrayPtr() : nullptr;
        for (int i = 0; i < count; ++i) {
            const std::uint32_t a = FilledBroadphase::objectOf(*listed[i].m_pProxy0);
            const std::uint32_t b = FilledBroadphase::objectOf(*listed[i].m_pProxy1);
            if (overlap(boxes[a], boxes[b])) {
                true_.push_back(pairKey(a, b));
            }
        }
    }

    btScalar margin_;
    FalsePairs falsePairs_;
    FilledBroadphase filled_;
    std::vector<BulletBox> fat_;
    std::vector<PairKey> true_;
};

std::string centimetres(double metres) {
    return valueText(100 * metres) + " cm";
}

PairMethod fatMethod(double margin, FalsePairs falsePairs) {
    const bool isExact = falsePairs == FalsePairs::kRefused;
    return {{"fat by " + centimetres(margin) + (isExact ? ", pairs tested" : ""),
             isExact ? "ours exact complete" : "ours complete",
             [=](const BroadphaseNeeds& needs, std::span<const BulletBox> boxes) {
                 const auto fat = std::make_shared<FatSource>(static_cast<btScalar>(margin),
                                                              falsePairs, needs, boxes);
                 return PairSource{[=](std::span<const BulletBox> moved) { fat->step(moved); },
                                   [=](std::vector<PairKey>& pairs) { fat->listPairs(pairs); }};
             }}};
}

/// Sets boxes and finds pairs in each `period`-th frame only; the pairs stand until the next.
PairMethod staleMethod(int period) {
    return {{"every " + std::to_string(period) + " frames", "ours",
             [period, make = hashMethod("").make](const BroadphaseNeeds& needs,
                                                  std::span<const BulletBox> boxes) {
                 const PairSource fresh = make(needs, boxes);
                 return PairSource{[=, frame = 0](std::span<const BulletBox> moved) mutable {
                                       if (frame++ % period == 0) {
                                           fresh.step(moved);
                                       }
                                   },
                                   fresh.listPairs};
             }}};
}

// --- The experiment -------------------------------------------------------------------------------

UpdatePlan updatePlan(const Effort& effort) {
    UpdatePlan plan;
    plan.objects = effort.quickOrFull<std::size_t>(2'000, 10'000);
    for (const double share : effort.isQuick ? std::vector{0.0, 0.05, 0.5, 1.0}
                                             : std::vector{0.0, 0.01, 0.05, 0.2, 0.5, 0.8, 1.0}) {
        const bool isTask = share == 0.05 || share == 0.5 || share == 1;
        plan.motions.push_back({.share = share, .isTask = isTask});
    }
    constexpr double kFast = 0.2;  // up to 12 m/s at 60 frames a second
    plan.motions.push_back({1, kFast});
    plan.trial = {effort.quickOrFull(8, 16), effort.quickOrFull(16, 30), 8};
    return plan;
}

}  // namespace

std::string Motion::name() const {
    return share == 0 ? "none move"
                      : (share == 1 ? "all" : valueText(100 * share) + " %") + " move by " +
                            centimetres(step);
}

std::vector<PairMethod> updatePolicies() {
    std::vector<PairMethod> policies{
        hashMethod("moved only"),
        hashMethod("all filed again", {.updatesBeforeRest = 1'000'000})};  // none ever rests
    for (const double margin : {0.02, 0.05, 0.2, 0.5}) {
        policies.push_back(fatMethod(margin, FalsePairs::kKept));
        policies.push_back(fatMethod(margin, FalsePairs::kRefused));
    }
    for (const int period : {2, 4, 8}) {
        policies.push_back(staleMethod(period));
    }
    constexpr double kCellSize = 2;  // [m] the paper's choice: larger than the objects
    policies.push_back(
        paperGridMethod("wiped and hashed again (paper)", kCellSize, FiledCells::kAll));
    policies.push_back(dbvtMethod(false));
    policies.push_back(dbvtMethod(true));
    return policies;
}

Findings measurePolicies(const UpdatePlan& plan, std::span<const PairMethod> policies,
                         std::uint64_t seed, const TellProgress& tell) {
    Measurements measured;
    measured.add("plan", {{"objects", plan.objects},
                          {"frames_together", plan.trial.framesTogether},
                          {"rounds", plan.trial.rounds}});
    for (std::size_t trial = 0; trial < plan.motions.size(); ++trial) {
        const Motion& motion = plan.motions[trial];
        tell(static_cast<double>(trial) / static_cast<double>(plan.motions.size()), motion.name());
        measured.add("trials", {{"trial", trial},
                                {"motion", motion.name()},
                                {"share", motion.share},
                                {"step", motion.step},
                                {"is_task", motion.isTask},
                                {"objects", plan.objects}});
        ScatterPlan scatterPlan;
        scatterPlan.movingShare = static_cast<float>(motion.share);
        scatterPlan.step = static_cast<float>(motion.step);
        BrownianScene scene(scatter(scatterPlan, plan.objects, seed), seed);
        tryPairs(trial, scene, policies, plan.trial, measured);
    }
    return findingsOf(kUpdateDeclaration, measured);
}

Experiment updateExperiment() {
    return {"P10",
            "Update policy",
            "What does it save to report only some moves to the broadphase, and what goes wrong?",
            4,
            40,
            [](const Effort& effort, const TellProgress& tell) {
                return measurePolicies(updatePlan(effort), updatePolicies(), effort.seed, tell);
            }};
}

}  // namespace hashphase::demos
