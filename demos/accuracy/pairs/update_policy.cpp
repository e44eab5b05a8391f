// SPDX-License-Identifier: Zlib
#include <demos/accuracy/pairs/update_policy.hpp>

#include <demos/report/data_table.hpp>

#include <algorithm>
#include <utility>

namespace hashphase::demos {
namespace {

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

class FatSource : public PairSource {
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

    void step(std::span<const BulletBox> boxes) override {
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

    void listPairs(std::vector<PairKey>& pairs) const override {
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

class StaleSource : public PairSource {
public:
    StaleSource(int period, std::unique_ptr<PairSource> source)
        : period_(period), source_(std::move(source)) {}

    void step(std::span<const BulletBox> boxes) override {
        if (frame_++ % period_ == 0) {
            source_->step(boxes);
        }
    }
    void listPairs(std::vector<PairKey>& pairs) const override { source_->listPairs(pairs); }

private:
    int period_;
    std::unique_ptr<PairSource> source_;
    int frame_ = 0;
};

std::string centimetres(double margin) {
    return valueText(100 * margin) + " cm";
}

}  // namespace

PairMethod refileAllMethod() {
    GridConfig config;
    config.updatesBeforeRest = 1'000'000;
    return hashMethod("all filed again", config);
}

PairMethod fatMethod(double margin, FalsePairs falsePairs) {
    PairMethod method;
    method.isExact = falsePairs == FalsePairs::kRefused;
    method.name = "fat by " + centimetres(margin) + (method.isExact ? ", pairs tested" : "");
    method.make = [margin, falsePairs](const BroadphaseNeeds& needs,
                                       std::span<const BulletBox> boxes) {
        return std::make_unique<FatSource>(static_cast<btScalar>(margin), falsePairs, needs, boxes);
    };
    return method;
}

PairMethod staleMethod(int period) {
    PairMethod method = hashMethod("every " + std::to_string(period) + " frames");
    method.isExact = false;
    method.isComplete = false;
    method.make = [period, make = method.make](const BroadphaseNeeds& needs,
                                               std::span<const BulletBox> boxes) {
        return std::make_unique<StaleSource>(period, make(needs, boxes));
    };
    return method;
}

}  // namespace hashphase::demos
