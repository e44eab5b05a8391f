// SPDX-License-Identifier: Zlib

// The Flexible Collision Library: its dynamic AABB tree and its spatial hash.

#include <tests/benchmarks/peers/peers.hpp>

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/broadphase_spatialhash.h>
#include <fcl/geometry/shape/box.h>

namespace hashphase::benchmarks {
namespace {

using demos::PairKey;

// FCL derives boxes from shapes; only the boxes count here.
class BoxObject : public fcl::CollisionObjectf {
public:
    BoxObject(const std::shared_ptr<fcl::CollisionGeometryf>& shape, std::uint32_t number)
        : fcl::CollisionObjectf(shape), number_(number) {}

    /// True when this changed the box.
    bool setBox(const Aabb<float>& box) {
        if (aabb.min_ == box.min() && aabb.max_ == box.max()) {
            return false;
        }
        aabb.min_ = box.min();
        aabb.max_ = box.max();
        return true;
    }
    [[nodiscard]] std::uint32_t number() const noexcept { return number_; }

private:
    std::uint32_t number_;
};

using Manager = fcl::BroadPhaseCollisionManagerf;

class FclContestant : public Contestant {
public:
    using MakeManager = std::unique_ptr<Manager> (*)(const FrameBoxes&, const Aabb<float>&);

    FclContestant(MakeManager makeManager, const Aabb<float>& bounds)
        : makeManager_(makeManager), bounds_(bounds) {}

    void fill(const FrameBoxes& frame) override {
        frame_ = frame;
        const auto shape = std::make_shared<fcl::Boxf>(1.0F, 1.0F, 1.0F);
        std::vector<fcl::CollisionObjectf*> all;
        for (std::size_t i = 0; i < frame.boxes.size(); ++i) {
            objects_.push_back(std::make_unique<BoxObject>(shape, static_cast<std::uint32_t>(i)));
            objects_.back()->setBox(frame.boxes[i]);
            all.push_back(objects_.back().get());
        }
        manager_ = makeManager_(frame, bounds_);
        manager_->registerObjects(all);
        manager_->setup();
    }

    void setAll(const FrameBoxes& frame) override {
        changed_.clear();
        for (std::size_t i = 0; i < objects_.size(); ++i) {
            if (objects_[i]->setBox(frame.boxes[i])) {
                changed_.push_back(objects_[i].get());
            }
        }
    }

    void findPairs() override {
        if (2 * changed_.size() > objects_.size()) {
            manager_->update();
        } else if (!changed_.empty()) {
            manager_->update(changed_);
        }
        changed_.clear();
        pairs_.clear();
        manager_->collide(this, &FclContestant::takePair);
    }

    void listPairs(std::vector<PairKey>& pairs) override { pairs = pairs_; }

private:
    // Returns whether to stop.
    static bool takePair(fcl::CollisionObjectf* a, fcl::CollisionObjectf* b, void* data) {
        auto& self = *static_cast<FclContestant*>(data);
        const std::uint32_t first = static_cast<const BoxObject*>(a)->number();
        const std::uint32_t second = static_cast<const BoxObject*>(b)->number();
        if (self.frame_.mayPair(first, second)) {
            self.pairs_.push_back(demos::pairKey(first, second));
        }
        return false;
    }

    MakeManager makeManager_;
    Aabb<float> bounds_;
    FrameBoxes frame_;
    std::vector<std::unique_ptr<BoxObject>> objects_;
    std::unique_ptr<Manager> manager_;
    std::vector<fcl::CollisionObjectf*> changed_;
    std::vector<PairKey> pairs_;
};

std::unique_ptr<Manager> makeTree(const FrameBoxes& /*frame*/, const Aabb<float>& /*bounds*/) {
    return std::make_unique<fcl::DynamicAABBTreeCollisionManagerf>();
}

// FCL leaves the cell size to its user: the mean edge of the boxes, doubled.
std::unique_ptr<Manager> makeHash(const FrameBoxes& frame, const Aabb<float>& bounds) {
    double sum = 0;
    for (const Aabb<float>& box : frame.boxes) {
        sum += static_cast<double>(box.sizes().mean());
    }
    const auto count = static_cast<double>(std::max<std::size_t>(frame.boxes.size(), 1));
    return std::make_unique<fcl::SpatialHashingCollisionManagerf<>>(
        static_cast<float>(2 * sum / count), bounds.min(), bounds.max(),
        static_cast<unsigned int>(2 * frame.boxes.size() + 1));
}

ContestantKind fclKind(const char* name, const char* title, const char* description,
                       std::size_t upTo, FclContestant::MakeManager makeManager) {
    return {.name = name,
            .title = title,
            .description = description,
            .package = HASHPHASE_BENCHMARKS_FCL_PACKAGE ", its templates compiled with our flags",
            .upTo = upTo,
            .make = [makeManager](const demos::BroadphaseNeeds& needs) {
                return std::make_unique<FclContestant>(makeManager, needs.bounds);
            }};
}

}  // namespace

std::vector<ContestantKind> fclKinds() {
    return {fclKind("fcl-tree", "fcl::DynamicAABBTreeCollisionManager",
                    "FCL's dynamic tree of boxes (up to 100,000 objects)", 100'000, makeTree),
            fclKind("fcl-hash", "fcl::SpatialHashingCollisionManager",
                    "FCL's spatial hash (up to 10,000 objects)", 10'000, makeHash)};
}

}  // namespace hashphase::benchmarks
