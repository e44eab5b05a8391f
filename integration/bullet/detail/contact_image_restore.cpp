// SPDX-License-Identifier: Zlib

// Makes algorithms own again what they owned.

#include <integration/bullet/detail/contact_image.hpp>

#include <broadphase/core/compiler.hpp>
#include <broadphase/core/ensure_capacity.hpp>
#include <integration/bullet/detail/algorithm_kind.hpp>
#include <integration/bullet/detail/bullet_members.hpp>
#include <integration/bullet/detail/owned_manifolds.hpp>

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btHashedSimplePairCache.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <algorithm>
#include <new>
#include <span>
#include <utility>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

/// For Bullet's dispatcher, which makes a manifold for two objects and looks at their shapes. Whose it is, is set
/// later.
btPersistentManifold* newManifold(btDispatcher& dispatcher) {
    struct Nobody : btCollisionObject {
        btSphereShape itsShape{1};
        Nobody() { setCollisionShape(&itsShape); }
    };
    static const Nobody nobody;
    return dispatcher.getNewManifold(&nobody, &nobody);
}

/// Owns manifolds of an algorithm that is never run any more, and releases them in its order.
class RetiredAlgorithm final : public btCollisionAlgorithm {
public:
    RetiredAlgorithm(const btCollisionAlgorithmConstructionInfo& info, int count)
        : btCollisionAlgorithm(info) {
        for (int i = 0; i < count; ++i) {
            manifolds_.push_back(newManifold(*m_dispatcher));
        }
    }
    ~RetiredAlgorithm() override {
        for (int i = 0; i < manifolds_.size(); ++i) {
            m_dispatcher->releaseManifold(manifolds_[i]);
        }
    }
    void processCollision(const btCollisionObjectWrapper* /*a*/,
                          const btCollisionObjectWrapper* /*b*/, const btDispatcherInfo& /*info*/,
                          btManifoldResult* /*result*/) override {}
    btScalar calculateTimeOfImpact(btCollisionObject* /*a*/, btCollisionObject* /*b*/,
                                   const btDispatcherInfo& /*info*/,
                                   btManifoldResult* /*result*/) override {
        return 1;
    }
    void getAllContactManifolds(btManifoldArray& found) override {
        for (int i = 0; i < manifolds_.size(); ++i) {
            found.push_back(manifolds_[i]);
        }
    }

private:
    btManifoldArray manifolds_;
};

}  // namespace

void freeQuietly(btCollisionAlgorithm* algorithm, btDispatcher* dispatcher) {
    if (algorithm == nullptr) {
        return;
    }
    const OwnedManifolds owned(*algorithm);
    for (int i = 0; i < owned.list().size(); ++i) {
        owned.list()[i]->setNumContacts(0);
    }
    algorithm->~btCollisionAlgorithm();
    dispatcher->freeCollisionAlgorithm(algorithm);
}

/// Makes algorithms own what they owned.
class ContactImage::Builder {
public:
    Builder(const ContactImage& image, btCollisionDispatcher& dispatcher)
        : image_(image), dispatcher_(dispatcher) {}

    /// `present` may be null; it is freed where it is of no use.
    [[nodiscard]] btCollisionAlgorithm* build(btCollisionAlgorithm* present,
                                              const btCollisionObjectWrapper& a,
                                              const btCollisionObjectWrapper& b) {
        if (next() == 0) {
            freeQuietly(present, &dispatcher_);
            return nullptr;
        }
        switch (kindOf(*a.getCollisionShape(), *b.getCollisionShape())) {
            case AlgorithmKind::leaf:
                return buildLeaf(present, a, b);
            case AlgorithmKind::compound:
                return buildCompound(present, a, b);
            case AlgorithmKind::twoCompounds:
            default: {
                btCollisionAlgorithm* const algorithm = buildCompound(present, a, b);
                buildChildPairs(*algorithm, a, b);
                return algorithm;
            }
        }
    }

    /// Notes that these are the next manifolds of then.
    void take(const btAlignedObjectArray<btPersistentManifold*>& manifolds, int count) {
        for (int i = 0; i < count; ++i) {
            image_.manifolds_.push_back(i < manifolds.size() ? manifolds[i] : nullptr);
        }
    }

    [[nodiscard]] int next() { return image_.owned_[image_.at_++]; }

private:
    [[nodiscard]] btCollisionAlgorithm* make(const btCollisionObjectWrapper& a,
                                             const btCollisionObjectWrapper& b) {
        // Some make their manifold at once, but not where the dispatcher leaves the pair out.
        for (const btCollisionObjectWrapper* wrapper : {&a, &b}) {
            auto& object = const_cast<btCollisionObject&>(*wrapper->getCollisionObject());
            ObjectMembers::activationState(object) = ACTIVE_TAG;
            ObjectMembers::checksCollisions(object) = 0;
        }
        return dispatcher_.findAlgorithm(&a, &b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
    }

    [[nodiscard]] btCollisionAlgorithm* buildLeaf(btCollisionAlgorithm* present,
                                                  const btCollisionObjectWrapper& a,
                                                  const btCollisionObjectWrapper& b) {
        const int count = next();
        if (present != nullptr) {
            const OwnedManifolds owned(*present);
            if (owned.list().size() == count) {
                take(owned.list(), count);
                return present;
            }
            freeQuietly(present, &dispatcher_);
        }
        btCollisionAlgorithm* const made = make(a, b);
        if (OwnedManifolds(*made).list().size() < count) {
            runFarApart(*made, a, b);
        }
        take(OwnedManifolds(*made).list(), count);
        return made;
    }

    // Others make their manifold when they first run: with the two so far apart that they find no contact.
    void runFarApart(btCollisionAlgorithm& algorithm, const btCollisionObjectWrapper& a,
                     const btCollisionObjectWrapper& b) {
        const auto radiusOf = [](const btCollisionObjectWrapper& wrapper) {
            btVector3 center;
            btScalar radius = 0;
            wrapper.getCollisionShape()->getBoundingSphere(center, radius);
            return radius + center.length();
        };
        const btTransform near = btTransform::getIdentity();
        btTransform far = near;
        far.setOrigin(btVector3(4 * (radiusOf(a) + radiusOf(b)) + 1, 0, 0));
        const btCollisionObjectWrapper there(nullptr, a.getCollisionShape(), a.getCollisionObject(),
                                             near, -1, -1);
        const btCollisionObjectWrapper away(nullptr, b.getCollisionShape(), b.getCollisionObject(),
                                            far, -1, -1);
        btManifoldResult result(&there, &away);
        algorithm.processCollision(&there, &away, btDispatcherInfo(), &result);
    }

    [[nodiscard]] btCollisionAlgorithm* buildCompound(btCollisionAlgorithm* present,
                                                      const btCollisionObjectWrapper& a,
                                                      const btCollisionObjectWrapper& b) {
        const bool isFirst = a.getCollisionShape()->isCompound();
        const btCollisionObjectWrapper& compound = isFirst ? a : b;
        const btCollisionObjectWrapper& other = isFirst ? b : a;
        const int count = next();
        if (present != nullptr &&
            !isUpToDate(*present, *a.getCollisionShape(), *b.getCollisionShape())) {
            freeQuietly(std::exchange(present, nullptr), &dispatcher_);
        }
        if (present == nullptr) {
            present = make(a, b);
        }
        auto& children =
            CompoundMembers::children(static_cast<btCompoundCollisionAlgorithm&>(*present));
        children.resize(count, nullptr);
        for (int i = 0; i < count; ++i) {
            children[i] = build(children[i], childOf(compound, i), other);
        }
        return present;
    }

    [[nodiscard]] static btCollisionObjectWrapper childOf(const btCollisionObjectWrapper& compound,
                                                          int child) {
        const btCompoundShape& shape = compoundOf(*compound.getCollisionShape());
        return {&compound,
                shape.getChildShape(child),
                compound.getCollisionObject(),
                compound.getWorldTransform(),
                -1,
                child};
    }

    /// From the last to the `first`, so that no other one changes its place.
    static void moveOutFrom(int first, btHashedSimplePairCache& cache, btSimplePairArray& to) {
        while (cache.GetCount() > first) {
            const btSimplePair last = cache.getOverlappingPairArray()[cache.GetCount() - 1];
            to.push_back(last);
            cache.removeOverlappingPair(last.m_indexA, last.m_indexB);
        }
    }

    void buildChildPairs(btCollisionAlgorithm& algorithm, const btCollisionObjectWrapper& a,
                         const btCollisionObjectWrapper& b) {
        btHashedSimplePairCache& cache = CompoundMembers::childPairs(algorithm);
        const btSimplePairArray& pairs = cache.getOverlappingPairArray();
        btSimplePairArray moved;
        const int count = next();
        for (int i = 0; i < count; ++i) {
            const int childOfA = next();
            const int childOfB = next();
            if (i < pairs.size() &&
                (pairs[i].m_indexA != childOfA || pairs[i].m_indexB != childOfB)) {
                moveOutFrom(i, cache, moved);
            }
            btSimplePair& pair = *cache.addOverlappingPair(childOfA, childOfB);
            for (int k = 0; k < moved.size(); ++k) {
                if (moved[k].m_indexA == childOfA && moved[k].m_indexB == childOfB) {
                    std::swap(pair.m_userPointer, moved[k].m_userPointer);
                }
            }
            pair.m_userPointer = build(static_cast<btCollisionAlgorithm*>(pair.m_userPointer),
                                       childOf(a, childOfA), childOf(b, childOfB));
        }
        moveOutFrom(count, cache, moved);
        for (int k = 0; k < moved.size(); ++k) {
            freeQuietly(static_cast<btCollisionAlgorithm*>(moved[k].m_userPointer), &dispatcher_);
        }
    }

    const ContactImage& image_;
    btCollisionDispatcher& dispatcher_;
};

void ContactImage::makeRoom() const {
    ensureCapacity(manifolds_, heads_.size());
}

void ContactImage::beginRestore() const {
    at_ = 0;
    manifolds_.clear();
}

btCollisionAlgorithm* ContactImage::restore(btCollisionAlgorithm* present,
                                            const btBroadphasePair& pair,
                                            btCollisionDispatcher& dispatcher) const {
    if (owned_[at_] == 0) {  // perhaps a proxy without an object
        ++at_;
        freeQuietly(present, &dispatcher);
        return nullptr;
    }
    const btCollisionObject& a = clientOf(pair.m_pProxy0);
    const btCollisionObject& b = clientOf(pair.m_pProxy1);
    const btCollisionObjectWrapper wrapperOfA(nullptr, a.getCollisionShape(), &a,
                                              a.getWorldTransform(), -1, -1);
    const btCollisionObjectWrapper wrapperOfB(nullptr, b.getCollisionShape(), &b,
                                              b.getWorldTransform(), -1, -1);
    return Builder(*this, dispatcher).build(present, wrapperOfA, wrapperOfB);
}

btCollisionAlgorithm* ContactImage::restoreRetired(btCollisionDispatcher& dispatcher) const {
    Builder builder(*this, dispatcher);
    const int count = builder.next();
    btCollisionAlgorithmConstructionInfo info(&dispatcher, 0);
    void* const memory = dispatcher.allocateCollisionAlgorithm(sizeof(RetiredAlgorithm));
    auto* const algorithm = new (memory) RetiredAlgorithm(info, count);
    builder.take(OwnedManifolds(*algorithm).list(), count);
    return algorithm;
}

void ContactImage::restore(btAlignedObjectArray<btPersistentManifold*>& manifolds,
                           btCollisionDispatcher& dispatcher) const {
    Builder builder(*this, dispatcher);
    const int count = builder.next();
    for (int i = manifolds.size(); i-- > count;) {
        manifolds[i]->setNumContacts(0);
        dispatcher.releaseManifold(manifolds[i]);
        manifolds.pop_back();
    }
    while (manifolds.size() < count) {
        manifolds.push_back(newManifold(dispatcher));
    }
    builder.take(manifolds, count);
}

// Others than were saved come last, in their order: of another world that has the same dispatcher, or of what
// bytes of a stranger's have brought about.
void ContactImage::endRestore(btCollisionDispatcher& dispatcher) const {
    const std::span list(dispatcher.getInternalManifoldPointer(),
                         static_cast<std::size_t>(dispatcher.getNumManifolds()));
    const bool areTheSame =
        list.size() == manifolds_.size() && std::ranges::count(manifolds_, nullptr) == 0;
    for (std::size_t i = 0; !areTheSame && i < list.size(); ++i) {
        list[i]->m_index1a = static_cast<int>(manifolds_.size() + i);
    }
    const btManifoldPoint* points = points_.begin();
    for (std::size_t i = 0; i < manifolds_.size(); ++i) {
        if (i + kManifoldsAhead < manifolds_.size() && manifolds_[i + kManifoldsAhead] != nullptr) {
            prefetchAll(*manifolds_[i + kManifoldsAhead]);
        }
        const Head& head = heads_[i];
        if (manifolds_[i] != nullptr) {
            fill(*manifolds_[i], head, points);
        }
        if (areTheSame) {
            list[static_cast<std::size_t>(head.place)] = manifolds_[i];
        }
        points += head.pointCount;
    }
    if (!areTheSame) {
        std::ranges::sort(list, {}, &btPersistentManifold::m_index1a);
        for (std::size_t i = 0; i < list.size(); ++i) {
            list[i]->m_index1a = static_cast<int>(i);
        }
    }
}

void ContactImage::fill(btPersistentManifold& manifold, const Head& head,
                        const btManifoldPoint* points) {
    manifold.setBodies(head.bodies[0], head.bodies[1]);
    manifold.setContactBreakingThreshold(head.breakingThreshold);
    manifold.setContactProcessingThreshold(head.processingThreshold);
    manifold.m_companionIdA = head.companions[0];
    manifold.m_companionIdB = head.companions[1];
    manifold.m_index1a = head.place;
    manifold.setNumContacts(head.pointCount);
    for (int k = 0; k < head.pointCount; ++k) {
        manifold.getContactPoint(k) = points[k];
    }
}

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
