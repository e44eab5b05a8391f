// SPDX-License-Identifier: Zlib

// Jolt's BroadPhaseQuadTree and the bodies whose boxes it reads, without the rest of a PhysicsSystem. A frame
// calls what PhysicsSystem::Update() calls, in batches as large.

#include <tests/benchmarks/peers/engine_boxes.hpp>

#include <Jolt/Jolt.h>

#include <Jolt/Physics/Body/BodyCreationSettings.h>
#include <Jolt/Physics/Body/BodyManager.h>
#include <Jolt/Physics/Body/BodyPair.h>
#include <Jolt/Physics/Collision/BroadPhase/BroadPhaseLayerInterfaceTable.h>
#include <Jolt/Physics/Collision/BroadPhase/BroadPhaseQuadTree.h>
#include <Jolt/Physics/Collision/BroadPhase/ObjectVsBroadPhaseLayerFilterTable.h>
#include <Jolt/Physics/Collision/ObjectLayerPairFilterTable.h>
#include <Jolt/Physics/Collision/Shape/ConvexShape.h>
#include <Jolt/RegisterTypes.h>

#include <stdexcept>

namespace hashphase::benchmarks {
namespace {

// Jolt's own box shapes have a centre and half edges, and boxes that differ by rounding. Bodies ask their
// shape for their box when they are told to, and keep it; so all share one, which answers what is to be set.
class BoxToSet final : public JPH::ConvexShape {
public:
    BoxToSet() : ConvexShape(JPH::EShapeSubType::UserConvex1) { SetEmbedded(); }

    JPH::AABox box;

    JPH::AABox GetWorldSpaceBounds(JPH::Mat44Arg /*transform*/,
                                   JPH::Vec3Arg /*scale*/) const override {
        return box;
    }
    JPH::AABox GetLocalBounds() const override { return box; }
    float GetInnerRadius() const override { return 0; }
    JPH::MassProperties GetMassProperties() const override { return {1, JPH::Mat44::sIdentity()}; }
    JPH::Vec3 GetSurfaceNormal(const JPH::SubShapeID& /*part*/,
                               JPH::Vec3Arg /*point*/) const override {
        return JPH::Vec3::sAxisY();
    }
    const Support* GetSupportFunction(ESupportMode /*mode*/, SupportBuffer& /*buffer*/,
                                      JPH::Vec3Arg /*scale*/) const override {
        return nullptr;
    }
    void CollideSoftBodyVertices(JPH::Mat44Arg /*transform*/, JPH::Vec3Arg /*scale*/,
                                 const JPH::CollideSoftBodyVertexIterator& /*vertices*/,
                                 JPH::uint /*count*/, int /*shape*/) const override {}
    Stats GetStats() const override { return {sizeof(*this), 0}; }
    float GetVolume() const override { return 0; }
#ifdef JPH_DEBUG_RENDERER
    void Draw(JPH::DebugRenderer* /*renderer*/, JPH::RMat44Arg /*transform*/,
              JPH::Vec3Arg /*scale*/, JPH::ColorArg /*color*/, bool /*usesMaterial*/,
              bool /*wireframe*/) const override {}
#endif
};

// Static and moving bodies, each in a tree of their own, as Jolt's manual has it.
constexpr JPH::ObjectLayer kStatic = 0;
constexpr JPH::ObjectLayer kMoving = 1;
constexpr JPH::uint kLayers = 2;

struct TreeOfLayer : JPH::BroadPhaseLayerInterfaceTable {
    TreeOfLayer() : BroadPhaseLayerInterfaceTable(kLayers, kLayers) {
        MapObjectToBroadPhaseLayer(kMoving, JPH::BroadPhaseLayer(kMoving));
    }
};

struct PairsOfLayers : JPH::ObjectLayerPairFilterTable {
    PairsOfLayers() : ObjectLayerPairFilterTable(kLayers) {
        EnableCollision(kStatic, kMoving);
        EnableCollision(kMoving, kMoving);
    }
};

// Numbers of objects are those of bodies, which count from 0.
class PairCollector final : public JPH::BodyPairCollector {
public:
    void AddHit(const JPH::BodyPair& pair) override {
        pairs.push_back(JPH::uint64{pair.mBodyA.GetIndex()} << 32 | pair.mBodyB.GetIndex());
    }

    JPH::Array<JPH::uint64> pairs;
};

JPH::AABox boxAt(const float* box) {
    return {JPH::Vec3(box[0], box[1], box[2]), JPH::Vec3(box[3], box[4], box[5])};
}

class JoltBoxes final : public EngineBoxes {
public:
    explicit JoltBoxes(const EngineScene& scene) : movedIn_(scene.objects, 0) {
        const auto count = static_cast<JPH::uint>(scene.objects);
        bodies_.Init(count, 0, treeOfLayer_);
        tree_.Init(&bodies_, treeOfLayer_);
        for (JPH::uint i = 0; i < count; ++i) {
            addBody(scene.boxes + std::size_t{6} * i, scene.areStatic[i] != 0);
        }
        JPH::BodyIDVector ids = moved_;
        const int added = static_cast<int>(count);
        const JPH::BroadPhase::AddState state = tree_.AddBodiesPrepare(ids.data(), added);
        tree_.AddBodiesFinalize(ids.data(), added, state);
    }

    void set(const float* boxes) override {
        for (JPH::Body* const body : bodies_.GetBodies()) {
            const JPH::AABox box = boxAt(boxes);
            if (body->GetWorldSpaceBounds() != box) {
                shape_.box = box;
                body->CalculateWorldSpaceBoundsInternal();
                markMoved(*body);
            }
            boxes += 6;
        }
        constexpr int kAtOnce = 64;
        const int count = static_cast<int>(moved_.size());
        for (int begin = 0; begin < count; begin += kAtOnce) {
            const int some = count - begin < kAtOnce ? count - begin : kAtOnce;
            tree_.NotifyBodiesAABBChanged(moved_.data() + begin, some, true);
        }
    }

    void findPairs() override {
        rebuildTree();
        putToSleep();
        wake();
        forgetPairsOfAwake();
        findPairsOfAwake();
        moved_.clear();
        hasStaticMoved_ = false;
        ++frame_;
    }

    [[nodiscard]] const std::uint64_t* pairs() const override {
        return reinterpret_cast<const std::uint64_t*>(collector_.pairs.data());
    }
    [[nodiscard]] std::size_t pairCount() const override { return collector_.pairs.size(); }

private:
    void addBody(const float* box, bool isStatic) {
        shape_.box = boxAt(box);
        JPH::Body* const body =
            bodies_.AllocateBody({&shape_, JPH::RVec3::sZero(), JPH::Quat::sIdentity(),
                                  isStatic ? JPH::EMotionType::Static : JPH::EMotionType::Dynamic,
                                  isStatic ? kStatic : kMoving});
        bodies_.AddBody(body);
        markMoved(*body);
    }

    void markMoved(const JPH::Body& body) {
        JPH::uint32& movedIn = movedIn_[body.GetID().GetIndex()];
        if (movedIn != frame_) {
            movedIn = frame_;
            moved_.push_back(body.GetID());
            hasStaticMoved_ |= body.IsStatic();
        }
    }

    // Jolt looks for pairs of bodies that are awake. They meet a static one that moved only when all are.
    [[nodiscard]] bool isAwake(JPH::uint64 body) const {
        return hasStaticMoved_ || movedIn_[body] == frame_;
    }

    // A step of Jolt's looks for pairs in the last tree, which it rebuilds meanwhile on another thread. On one
    // thread either order takes as long.
    void rebuildTree() {
        tree_.FrameSync();
        tree_.LockModifications();
        const JPH::BroadPhase::UpdateState state = tree_.UpdatePrepare();
        tree_.UpdateFinalize(state);
        tree_.UnlockModifications();
    }

    void putToSleep() {
        changing_.clear();
        const JPH::BodyID* const active = bodies_.GetActiveBodiesUnsafe(JPH::EBodyType::RigidBody);
        for (JPH::uint32 i = 0; i < activeCount(); ++i) {
            if (!isAwake(active[i].GetIndex())) {
                changing_.push_back(active[i]);
            }
        }
        bodies_.DeactivateBodies(changing_.data(), static_cast<int>(changing_.size()));
    }

    void wake() {
        changing_.clear();
        const auto add = [this](const JPH::Body& body) {
            if (!body.IsStatic() && !body.IsActive()) {
                changing_.push_back(body.GetID());
            }
        };
        if (hasStaticMoved_) {
            for (const JPH::Body* const body : bodies_.GetBodies()) {
                add(*body);
            }
        } else {
            for (const JPH::BodyID id : moved_) {
                add(bodies_.GetBody(id));
            }
        }
        bodies_.ActivateBodies(changing_.data(), static_cast<int>(changing_.size()));
    }

    void forgetPairsOfAwake() {
        JPH::Array<JPH::uint64>& pairs = collector_.pairs;
        std::size_t kept = 0;
        for (const JPH::uint64 pair : pairs) {
            if (!isAwake(pair >> 32) && !isAwake(static_cast<JPH::uint32>(pair))) {
                pairs[kept++] = pair;
            }
        }
        pairs.resize(kept);
    }

    void findPairsOfAwake() {
        constexpr JPH::uint32 kAtOnce = 16;
        JPH::BodyID batch[kAtOnce];  // which the tree reorders
        const JPH::BodyID* const active = bodies_.GetActiveBodiesUnsafe(JPH::EBodyType::RigidBody);
        for (JPH::uint32 begin = 0; begin < activeCount(); begin += kAtOnce) {
            JPH::uint32 count = 0;
            while (count < kAtOnce && begin + count < activeCount()) {
                batch[count] = active[begin + count];
                ++count;
            }
            // A speculative distance would make boxes larger.
            tree_.FindCollidingPairs(batch, static_cast<int>(count), 0.0F, treesToAsk_,
                                     pairsOfLayers_, collector_);
        }
    }

    [[nodiscard]] JPH::uint32 activeCount() const {
        return bodies_.GetNumActiveBodies(JPH::EBodyType::RigidBody);
    }

    BoxToSet shape_;
    TreeOfLayer treeOfLayer_;
    PairsOfLayers pairsOfLayers_;
    JPH::ObjectVsBroadPhaseLayerFilterTable treesToAsk_{treeOfLayer_, kLayers, pairsOfLayers_,
                                                        kLayers};
    JPH::BodyManager bodies_;
    JPH::BroadPhaseQuadTree tree_;
    JPH::uint32 frame_ = 1;
    JPH::Array<JPH::uint32> movedIn_;  // the frame, by body
    JPH::BodyIDVector moved_;          // in this frame
    bool hasStaticMoved_ = false;
    JPH::BodyIDVector changing_;  // scratch
    PairCollector collector_;
};

}  // namespace

EngineBoxes* makeJoltBoxes(const EngineScene& scene) {
    if (!JPH::VerifyJoltVersionID()) {
        throw std::runtime_error(
            "Jolt was compiled with other settings than its CMake package says: build it in "
            "Release, with "
            "-DDEBUG_RENDERER_IN_DEBUG_AND_RELEASE=OFF -DPROFILER_IN_DEBUG_AND_RELEASE=OFF.");
    }
    JPH::RegisterDefaultAllocator();
    return new JoltBoxes(scene);
}

EngineVersion joltVersion() {
    return {{JPH_VERSION_MAJOR, JPH_VERSION_MINOR, JPH_VERSION_PATCH}};
}

}  // namespace hashphase::benchmarks
