// SPDX-License-Identifier: Zlib

// Hastings, Mesit, Guha, "Optimization of Large-Scale, Real-Time Simulations by Spatial Hashing",
// "AI and Decision Making"; and Bullet's own way.

#include <demos/accuracy/proximity/neighbour_method.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace hashphase::demos {
namespace {

btVector3 centreOf(const BulletBox& box) {
    return (box.min + box.max) / 2;
}

/// The paper's buckets are a plain array; an agent lies in the buckets of its box's four corners, and
/// is counted as often as it is met. Its indices are clamped to the array, which the printed loop
/// leaves at the borders.
class PaperProximity : public NeighbourSearch {
public:
    explicit PaperProximity(const NeighbourNeeds& needs)
        : needs_(needs),
          min_(needs.bounds.min()),
          width_(static_cast<int>(std::ceil(needs.bounds.sizes().maxCoeff() / needs.cellSize))),
          buckets_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(width_)) {}

    void take(const AgentFrame& frame) override {
        for (std::vector<std::uint32_t>& bucket : buckets_) {
            bucket.clear();
        }
        boxes_ = frame.boxes;
        for (std::uint32_t agent = 0; agent < boxes_.size(); ++agent) {
            hash(agent);
        }
    }

    void forEach(Visit visit) override {
        const int offset = static_cast<int>(needs_.radius / needs_.cellSize);
        for (std::uint32_t agent = 0; agent < boxes_.size(); ++agent) {
            const Vector3<float> centre = boxes_[agent].center();
            const int baseX = columnOf(centre.x(), 0);
            const int baseZ = columnOf(centre.z(), 2);
            found_.clear();
            for (int x = std::max(0, baseX - offset); x < std::min(width_, baseX + offset); ++x) {
                for (int z = std::max(0, baseZ - offset); z < std::min(width_, baseZ + offset);
                     ++z) {
                    addOthers(bucketAt(x, z), agent);
                }
            }
            visit(agent, found_);
        }
    }

private:
    [[nodiscard]] int columnOf(float coordinate, int axis) const {
        const float column = std::floor((coordinate - min_[axis]) / needs_.cellSize);
        return std::clamp(static_cast<int>(column), 0, width_ - 1);
    }
    [[nodiscard]] std::vector<std::uint32_t>& bucketAt(int x, int z) {
        return buckets_[static_cast<std::size_t>(x * width_ + z)];
    }

    void hash(std::uint32_t agent) {
        const Aabb<float>& box = boxes_[agent];
        const std::array<int, 2> x{columnOf(box.min().x(), 0), columnOf(box.max().x(), 0)};
        const std::array<int, 2> z{columnOf(box.min().z(), 2), columnOf(box.max().z(), 2)};
        for (std::size_t i = 0; i < (x[0] == x[1] ? 1U : 2U); ++i) {
            for (std::size_t k = 0; k < (z[0] == z[1] ? 1U : 2U); ++k) {
                bucketAt(x[i], z[k]).push_back(agent);
            }
        }
    }

    void addOthers(const std::vector<std::uint32_t>& bucket, std::uint32_t self) {
        for (const std::uint32_t agent : bucket) {
            if (agent != self) {
                found_.push_back(agent);
            }
        }
    }

    NeighbourNeeds needs_;
    Vector3<float> min_;
    int width_;
    std::vector<std::vector<std::uint32_t>> buckets_;
    std::span<const Aabb<float>> boxes_;
    std::vector<std::uint32_t> found_;
};

class BulletProximity : public NeighbourSearch {
public:
    explicit BulletProximity(const NeighbourNeeds& needs)
        : radius_(needs.radius),
          filled_(broadphaseKind("dbvt-deferred"), {needs.bounds, needs.agents, {}}) {}

    void take(const AgentFrame& frame) override {
        if (boxes_.empty()) {
            for (std::uint32_t agent = 0; agent < frame.bulletBoxes.size(); ++agent) {
                filled_.create(agent, frame.bulletBoxes[agent], {});
            }
        } else {
            filled_.setAll(frame.bulletBoxes);
        }
        boxes_ = frame.bulletBoxes;
    }

    void forEach(Visit visit) override {
        const btVector3 reach(radius_, radius_, radius_);
        for (std::uint32_t agent = 0; agent < boxes_.size(); ++agent) {
            found_.clear();
            const btVector3 centre = centreOf(boxes_[agent]);
            Near near(*this, centre, agent);
            filled_.broadphase().aabbTest(centre - reach, centre + reach, near);
            visit(agent, found_);
        }
    }

private:
    struct Near : btBroadphaseAabbCallback {
        Near(BulletProximity& search, const btVector3& centre, std::uint32_t self)
            : search_(search), centre_(centre), self_(self) {}

        bool process(const btBroadphaseProxy* proxy) override {
            const std::uint32_t other = FilledBroadphase::objectOf(*proxy);
            const btVector3 way = centreOf(search_.boxes_[other]) - centre_;
            if (other != self_ && way.length2() <= search_.radius_ * search_.radius_) {
                search_.found_.push_back(other);
            }
            return true;
        }

    private:
        BulletProximity& search_;
        btVector3 centre_;
        std::uint32_t self_;
    };

    btScalar radius_;
    FilledBroadphase filled_;
    std::span<const BulletBox> boxes_;
    std::vector<std::uint32_t> found_;
};

}  // namespace

NeighbourMethod paperProximityMethod() {
    NeighbourMethod method;
    method.name = "cells, as printed (paper)";
    method.origin = MethodOrigin::kPaper;
    method.make = [](const NeighbourNeeds& needs) {
        return std::make_unique<PaperProximity>(needs);
    };
    return method;
}

NeighbourMethod bulletProximityMethod() {
    NeighbourMethod method;
    method.name = "btDbvtBroadphase, then distance";
    method.origin = MethodOrigin::kBullet;
    method.isExact = true;
    method.usesCells = false;
    method.make = [](const NeighbourNeeds& needs) {
        return std::make_unique<BulletProximity>(needs);
    };
    return method;
}

}  // namespace hashphase::demos
