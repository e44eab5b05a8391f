// SPDX-License-Identifier: Zlib

// PhysX's broadphases by themselves, on one thread. They report pairs found and pairs lost; the set of those
// that are is kept in PhysX's own hash set.

#include <tests/benchmarks/peers/engine_boxes.hpp>

#include <PxBroadPhase.h>
#include <extensions/PxBroadPhaseExt.h>
#include <extensions/PxDefaultAllocator.h>
#include <extensions/PxDefaultErrorCallback.h>
#include <foundation/PxArray.h>
#include <foundation/PxFoundation.h>
#include <foundation/PxHashSet.h>
#include <foundation/PxPhysicsVersion.h>

#include <stdexcept>

namespace hashphase::benchmarks {
namespace {

using physx::PxArray;
using physx::PxBounds3;
using physx::PxU32;
using physx::PxU64;
using physx::PxVec3;

// PhysX allows one in a process.
void makeFoundation() {
    static physx::PxDefaultAllocator allocator;
    static physx::PxDefaultErrorCallback errors;
    static const physx::PxFoundation* const foundation =
        PxCreateFoundation(PX_PHYSICS_VERSION, allocator, errors);
    if (foundation == nullptr) {
        throw std::runtime_error("PhysX's library is of another version than its headers.");
    }
}

PxBounds3 boxAt(const float* box) {
    return {PxVec3(box[0], box[1], box[2]), PxVec3(box[3], box[4], box[5])};
}

bool isSame(const PxBounds3& a, const PxBounds3& b) {
    return a.minimum == b.minimum && a.maximum == b.maximum;
}

PxU64 pairKey(const physx::PxBroadPhasePair& pair) {
    const PxU32 a = pair.mID0;
    const PxU32 b = pair.mID1;
    return a < b ? PxU64{a} << 32 | b : PxU64{b} << 32 | a;
}

class PhysxBoxes final : public EngineBoxes {
public:
    PhysxBoxes(const EngineScene& scene, physx::PxBroadPhaseType::Enum type)
        : objects_(static_cast<PxU32>(scene.objects)),
          broadphase_(physx::PxCreateBroadPhase(physx::PxBroadPhaseDesc(type))) {
        if (type == physx::PxBroadPhaseType::eMBP) {
            addRegions(boxAt(scene.bounds));
        }
        // PhysX wants one more than there are: it reads a number beyond a box.
        bounds_.resize(objects_ + 1, boxAt(scene.bounds));
        groups_.resize(objects_ + 1, physx::PxGetBroadPhaseStaticFilterGroup());
        distances_.resize(objects_ + 1, 0.0F);
        for (PxU32 i = 0; i < objects_; ++i) {
            bounds_[i] = boxAt(scene.boxes + std::size_t{6} * i);
            if (scene.areStatic[i] == 0) {
                groups_[i] = physx::PxGetBroadPhaseDynamicFilterGroup(i);
            }
            changed_.pushBack(i);
        }
        update(objects_, 0);
    }
    ~PhysxBoxes() override { broadphase_->release(); }

    void set(const float* boxes) override {
        for (PxU32 i = 0; i < objects_; ++i) {
            const PxBounds3 box = boxAt(boxes);
            if (!isSame(bounds_[i], box)) {
                bounds_[i] = box;
                changed_.pushBack(i);
            }
            boxes += 6;
        }
    }

    void findPairs() override { update(0, changed_.size()); }

    [[nodiscard]] const std::uint64_t* pairs() const override { return pairs_.getEntries(); }
    [[nodiscard]] std::size_t pairCount() const override { return pairs_.size(); }

private:
    // A grid over the two longer axes of the world, of 4 x 4 regions to begin with, as PhysX's headers have
    // it. Of 2 to 16 an axis, these were the fastest.
    void addRegions(const PxBounds3& world) {
        constexpr PxU32 kMostPerAxis = 8;
        const PxU32 perAxis = objects_ < 3'000 ? 2 : objects_ < 50'000 ? 4 : kMostPerAxis;
        const PxVec3 edges = world.getDimensions();
        const PxU32 flattest =
            edges.x < edges.y ? (edges.x < edges.z ? 0 : 2) : (edges.y < edges.z ? 1 : 2);
        PxBounds3 regions[kMostPerAxis * kMostPerAxis];
        const PxU32 count =
            physx::PxBroadPhaseExt::createRegionsFromWorldBounds(regions, world, perAxis, flattest);
        for (PxU32 i = 0; i < count; ++i) {
            broadphase_->getRegions()->addRegion({regions[i], nullptr}, false, nullptr, nullptr);
        }
    }

    // What changed is new, or has moved.
    void update(PxU32 created, PxU32 moved) {
        const physx::PxBroadPhaseUpdateData changes(
            changed_.begin(), created, changed_.begin(), moved, nullptr, 0, bounds_.begin(),
            groups_.begin(), distances_.begin(), bounds_.size());
        physx::PxBroadPhaseResults results;
        broadphase_->updateAndFetchResults(results, changes);
        changed_.clear();
        for (PxU32 i = 0; i < results.mNbDeletedPairs; ++i) {
            pairs_.erase(pairKey(results.mDeletedPairs[i]));
        }
        for (PxU32 i = 0; i < results.mNbCreatedPairs; ++i) {
            pairs_.insert(pairKey(results.mCreatedPairs[i]));
        }
    }

    PxU32 objects_;
    physx::PxBroadPhase* broadphase_;
    PxArray<PxBounds3> bounds_;  // by object
    PxArray<physx::PxBpFilterGroup> groups_;
    PxArray<float> distances_;  // by which boxes are to grow: none
    PxArray<PxU32> changed_;    // objects
    physx::PxCoalescedHashSet<PxU64> pairs_;
};

EngineBoxes* makeBoxes(const EngineScene& scene, physx::PxBroadPhaseType::Enum type) {
    makeFoundation();
    return new PhysxBoxes(scene, type);
}

}  // namespace

EngineBoxes* makePhysxAutomaticBoxes(const EngineScene& scene) {
    return makeBoxes(scene, physx::PxBroadPhaseType::eABP);
}

EngineBoxes* makePhysxRegionBoxes(const EngineScene& scene) {
    return makeBoxes(scene, physx::PxBroadPhaseType::eMBP);
}

EngineVersion physxVersion() {
    return {{PX_PHYSICS_VERSION_MAJOR, PX_PHYSICS_VERSION_MINOR, PX_PHYSICS_VERSION_BUGFIX}};
}

}  // namespace hashphase::benchmarks
