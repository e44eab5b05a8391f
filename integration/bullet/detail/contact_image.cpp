// SPDX-License-Identifier: Zlib
#include <integration/bullet/detail/contact_image.hpp>

#include <broadphase/core/compiler.hpp>
#include <integration/bullet/detail/algorithm_kind.hpp>
#include <integration/bullet/detail/bullet_members.hpp>
#include <integration/bullet/detail/owned_manifolds.hpp>

#include <BulletCollision/CollisionDispatch/btHashedSimplePairCache.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>

#include <algorithm>
#include <sstream>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {

/// Writes what an algorithm owns.
class ContactImage::Writer {
public:
    explicit Writer(ContactImage& image) : image_(image) {}

    void write(btCollisionAlgorithm* algorithm, const btCollisionShape& a,
               const btCollisionShape& b) {
        image_.owned_.push_back(algorithm != nullptr ? 1 : 0);
        if (algorithm == nullptr) {
            return;
        }
        const AlgorithmKind kind = kindOf(a, b);
        if (!image_.isOfKind(*algorithm, kind)) {
            image_.fault_ =
                "A pair has a collision algorithm that a snapshot cannot keep. Use Bullet's "
                "default algorithms only.";
            return;
        }
        if (kind != AlgorithmKind::leaf && !isUpToDate(*algorithm, a, b)) {
            image_.fault_ =
                "A compound shape changed after the last step. Call "
                "SpatialHashBroadphase::shapeChanged() for its object, and step the world.";
            return;
        }
        if (kind == AlgorithmKind::leaf) {
            writeManifolds(*algorithm);
            return;
        }
        const btCompoundShape& compound = compoundOf(a.isCompound() ? a : b);
        const btCollisionShape& other = a.isCompound() ? b : a;
        const auto& children =
            CompoundMembers::children(static_cast<btCompoundCollisionAlgorithm&>(*algorithm));
        image_.owned_.push_back(children.size());
        for (int i = 0; i < children.size(); ++i) {
            write(children[i], *compound.getChildShape(i), other);
        }
        if (kind == AlgorithmKind::twoCompounds) {
            const btSimplePairArray& pairs =
                CompoundMembers::childPairs(*algorithm).getOverlappingPairArray();
            image_.owned_.push_back(pairs.size());
            for (int i = 0; i < pairs.size(); ++i) {
                image_.owned_.push_back(pairs[i].m_indexA);
                image_.owned_.push_back(pairs[i].m_indexB);
                write(static_cast<btCollisionAlgorithm*>(pairs[i].m_userPointer),
                      *compoundOf(a).getChildShape(pairs[i].m_indexA),
                      *compoundOf(b).getChildShape(pairs[i].m_indexB));
            }
        }
    }

    void writeManifolds(btCollisionAlgorithm& algorithm) {
        write(OwnedManifolds(algorithm).list());
    }

    void write(const btAlignedObjectArray<btPersistentManifold*>& manifolds) {
        image_.owned_.push_back(manifolds.size());
        for (int i = 0; i < manifolds.size(); ++i) {
            image_.manifolds_.push_back(manifolds[i]);
        }
    }

private:
    ContactImage& image_;
};

// To compare names of classes takes as long as all else that is done about a pair.
bool ContactImage::isOfKind(const btCollisionAlgorithm& algorithm, AlgorithmKind kind) {
    const void* const table = virtualTableOf(algorithm);
    std::vector<const void*>& known = knownTables_[static_cast<std::size_t>(kind)];
    if (std::ranges::find(known, table) != known.end()) {
        return true;
    }
    const bool isKnown = detail::isOfKind(algorithm, kind);
    if (isKnown) {
        known.push_back(table);
    }
    return isKnown;
}

void ContactImage::begin() {
    owned_.clear();
    heads_.clear();
    points_.clear();
    manifolds_.clear();
    fault_.clear();
}

void ContactImage::save(const btBroadphasePair& pair) {
    if (pair.m_algorithm == nullptr) {
        owned_.push_back(0);
        return;
    }
    Writer(*this).write(pair.m_algorithm, *clientOf(pair.m_pProxy0).getCollisionShape(),
                        *clientOf(pair.m_pProxy1).getCollisionShape());
}

void ContactImage::saveRetired(btCollisionAlgorithm& algorithm) {
    Writer(*this).writeManifolds(algorithm);
}

void ContactImage::save(const btAlignedObjectArray<btPersistentManifold*>& manifolds) {
    Writer(*this).write(manifolds);
}

std::string ContactImage::end(const btCollisionDispatcher& dispatcher) {
    if (!fault_.empty()) {
        return fault_;
    }
    const auto count = static_cast<std::size_t>(dispatcher.getNumManifolds());
    if (count != manifolds_.size()) {
        std::ostringstream sentence;
        sentence << "Of " << count << " contact manifolds, " << count - manifolds_.size()
                 << " belong to no pair of the world, its ghosts or its predicted contacts. "
                    "Release them, and share the dispatcher with no other world.";
        return sentence.str();
    }
    heads_.reserve(count);
    bool haveUserData = false;
    for (std::size_t i = 0; i < count; ++i) {
        if (i + kManifoldsAhead < count) {
            prefetchAll(*manifolds_[i + kManifoldsAhead]);
        }
        const btPersistentManifold& manifold = *manifolds_[i];
        heads_.push_back({{manifold.getBody0(), manifold.getBody1()},
                          manifold.getContactBreakingThreshold(),
                          manifold.getContactProcessingThreshold(),
                          {manifold.m_companionIdA, manifold.m_companionIdB},
                          manifold.m_index1a,
                          manifold.getNumContacts()});
        points_.reserveMore(MANIFOLD_CACHE_SIZE);
        for (int k = 0; k < manifold.getNumContacts(); ++k) {
            const btManifoldPoint& point = manifold.getContactPoint(k);
            points_.push_back(point);
            haveUserData |= point.m_userPersistentData != nullptr;
        }
    }
    return haveUserData ? "A contact point has user data (m_userPersistentData), which a snapshot "
                          "cannot keep. Keep that data elsewhere."
                        : std::string();
}

std::size_t ContactImage::memoryBytes() const noexcept {
    return sizeof(*this) + owned_.capacity() * sizeof(int) + heads_.capacity() * sizeof(Head) +
           points_.capacity() * sizeof(btManifoldPoint) + manifolds_.capacity() * sizeof(void*);
}

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
