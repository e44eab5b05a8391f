// SPDX-License-Identifier: Zlib
#include <demos/stability/bullet_subject.hpp>

#include <demos/scenes/destroy_proxies.hpp>
#include <integration/bullet/conversions.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/NarrowPhaseCollision/btRaycastCallback.h>
#include <LinearMath/btAabbUtil2.h>
#include <btBulletCollisionCommon.h>

#include <array>
#include <numeric>

namespace hashphase::demos {
namespace {

const SpatialHashBroadphase* hashOf(const btBroadphaseInterface& broadphase) {
    return dynamic_cast<const SpatialHashBroadphase*>(&broadphase);
}

/// A callback of any query: the objects of what is found.
template <class Callback>
struct NoteObjects final : Callback {
    bool process(const btBroadphaseProxy* proxy) override {
        found.push_back(BulletSubject::objectOf(*proxy));
        return true;
    }
    Objects found;
};

// The fields that btCollisionWorld gives the callback of a ray, or of a box that is moved along it: of no
// length, the ray is normalised to NaN, and the box to zero.
void setRay(btBroadphaseRayCallback& callback, const btVector3& way, bool isCast) {
    const btVector3 direction = isCast && way.fuzzyZero() ? btVector3(0, 0, 0) : way / way.length();
    for (int axis = 0; axis < 3; ++axis) {
        callback.m_rayDirectionInverse[axis] =
            direction[axis] == 0 ? btScalar(BT_LARGE_FLOAT) : btScalar(1) / direction[axis];
        callback.m_signs[axis] = callback.m_rayDirectionInverse[axis] < 0 ? 1 : 0;
    }
    callback.m_lambda_max = direction.dot(way);
}

Objects sorted(Objects objects) {
    std::sort(objects.begin(), objects.end());
    return objects;
}

struct NearestHit final : btTriangleRaycastCallback {
    using btTriangleRaycastCallback::btTriangleRaycastCallback;
    btScalar reportHit(const btVector3& /*normal*/, btScalar fraction, int /*part*/,
                       int /*index*/) override {
        return fraction;
    }
};

// Bullet's way: a ray down through a mesh.
struct BulletGround {
    btTriangleMesh mesh;
    std::unique_ptr<btBvhTriangleMeshShape> shape;

    explicit BulletGround(std::span<const Vector3<btScalar>> corners) {
        for (std::size_t i = 0; i < corners.size(); i += 3) {
            mesh.addTriangle(toBullet(corners[i]), toBullet(corners[i + 1]),
                             toBullet(corners[i + 2]));
        }
        shape = std::make_unique<btBvhTriangleMeshShape>(&mesh, true);
    }

    [[nodiscard]] std::optional<double> below(const Vector3<btScalar>& point) const {
        const btVector3 from = toBullet(point);
        const btVector3 to(from.x(), -10, from.z());
        NearestHit hit(from, to);
        shape->performRaycast(&hit, from, to);
        if (hit.m_hitFraction >= 1) {
            return std::nullopt;
        }
        return static_cast<double>(from.y()) -
               static_cast<double>(hit.m_hitFraction) * static_cast<double>(from.y() + 10);
    }
};

struct NoteLeaves final : btDbvt::ICollide {
    void Process(const btDbvtNode* leaf) override {
        found.push_back(
            BulletSubject::objectOf(*static_cast<const btBroadphaseProxy*>(leaf->data)));
    }
    Objects found;
};

}  // namespace

BulletSubject::BulletSubject(std::unique_ptr<btBroadphaseInterface> broadphase, std::size_t objects,
                             bool freesProxies)
    : freesProxies_(freesProxies),
      objects_(objects),
      proxies_(objects),
      broadphase_(std::move(broadphase)) {
    std::iota(objects_.begin(), objects_.end(), 0U);
}

BulletSubject::~BulletSubject() {
    if (!freesProxies_) {
        destroyProxies(*broadphase_, proxies_);
    }
}

void BulletSubject::create(std::uint32_t object, const Box& box) {
    proxies_[object] = broadphase_->createProxy(
        toBullet(box.min()), toBullet(box.max()), BOX_SHAPE_PROXYTYPE, &objects_[object],
        btBroadphaseProxy::DefaultFilter, btBroadphaseProxy::AllFilter, nullptr);
}

void BulletSubject::move(std::uint32_t object, const Box& box) {
    broadphase_->setAabb(proxies_[object], toBullet(box.min()), toBullet(box.max()), nullptr);
}

void BulletSubject::destroy(std::uint32_t object) {
    broadphase_->destroyProxy(proxies_[object], nullptr);
    proxies_[object] = nullptr;
}

void BulletSubject::listPairs(Keys& pairs) const {
    pairs = pairsIn(*broadphase_->getOverlappingPairCache(), objectOf);
}

Objects BulletSubject::touching(const Box& region) const {
    NoteObjects<btBroadphaseAabbCallback> callback;
    broadphase_->aabbTest(toBullet(region.min()), toBullet(region.max()), callback);
    return callback.found;
}

std::optional<Objects> BulletSubject::rayTest(const Point& from, const Point& to,
                                              const Box& cast) const {
    NoteObjects<btBroadphaseRayCallback> callback;
    setRay(callback, toBullet(to) - toBullet(from), cast.min() != cast.max());
    broadphase_->rayTest(toBullet(from), toBullet(to), callback, toBullet(cast.min()),
                         toBullet(cast.max()));
    return sorted(std::move(callback.found));
}

// Called as btDbvtBroadphase does.
bool BulletSubject::passesRayTest(const Point& from, const Point& to, const Box& cast,
                                  const Box& box) const {
    NoteObjects<btBroadphaseRayCallback> fields;
    setRay(fields, toBullet(to) - toBullet(from), cast.min() != cast.max());
    const std::array<btVector3, 2> bounds{toBullet(box.min()) - toBullet(cast.max()),
                                          toBullet(box.max()) - toBullet(cast.min())};
    btScalar enter = 0;
    return btRayAabb2(toBullet(from), fields.m_rayDirectionInverse, fields.m_signs, bounds.data(),
                      enter, 0, fields.m_lambda_max);
}

std::optional<Objects> BulletSubject::behindAll(std::span<const Plane<btScalar>> planes) const {
    const auto* dbvt = dynamic_cast<const btDbvtBroadphase*>(broadphase_.get());
    if (dbvt == nullptr) {
        return std::nullopt;
    }
    std::vector<btVector3> normals;
    std::vector<btScalar> offsets;
    for (const Plane<btScalar>& plane : planes) {
        normals.push_back(toBullet(plane.normal()));
        offsets.push_back(plane.offset());
    }
    NoteLeaves leaves;
    for (const btDbvt& tree : dbvt->m_sets) {
        btDbvt::collideKDOP(tree.m_root, normals.data(), offsets.data(),
                            static_cast<int>(planes.size()), leaves);
    }
    return sorted(std::move(leaves.found));
}

BulletSubject::GroundBelow BulletSubject::groundOf(std::span<const Point> corners) const {
    return [mesh = std::make_shared<BulletGround>(corners)](const Point& point) {
        return mesh->below(point);
    };
}

const Grid<btScalar>* BulletSubject::grid() const {
    const SpatialHashBroadphase* hash = hashOf(*broadphase_);
    return hash == nullptr ? nullptr : &hash->grid();
}

PairCost BulletSubject::cost() const {
    const SpatialHashBroadphase* hash = hashOf(*broadphase_);
    return hash == nullptr ? PairCost{} : hash->lastCost();
}

std::size_t BulletSubject::memoryBytes() const {
    const SpatialHashBroadphase* hash = hashOf(*broadphase_);
    return hash == nullptr ? 0 : hash->memoryBytes();
}

std::string BulletSubject::validate() const {
    const SpatialHashBroadphase* hash = hashOf(*broadphase_);
    return hash == nullptr ? std::string() : hash->validate();
}

}  // namespace hashphase::demos
