// SPDX-License-Identifier: Zlib

// The queries of SpatialHashBroadphase.

#include <integration/bullet/conversions.hpp>
#include <integration/bullet/shape_pick.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <LinearMath/btAabbUtil2.h>

#include <algorithm>
#include <limits>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

/// How far off the ray [m], on each axis, btRayAabb2() may see a hit. Bullet's inverse of a direction
/// of 0 is a large number and not infinity: a ray of 1e18 m hits what is a metre beside it.
btVector3 slackOf(const btBroadphaseRayCallback& callback, const btVector3& way) {
    btVector3 slack(0, 0, 0);
    for (int axis = 0; axis < 3; ++axis) {
        const btScalar reach = btFabs(callback.m_lambda_max / callback.m_rayDirectionInverse[axis]);
        const btScalar excess = reach - btFabs(way[axis]);
        slack[axis] = excess > 0 ? excess : btScalar(0);  // also for NaN, of a ray of no length
    }
    return slack;
}

/// A ray as Bullet's callbacks describe it: the segment says where to look, btRayAabb2() with the
/// callback's fields what is hit, and the key where, as a fraction of the ray.
class CallbackRayRegion {
public:
    CallbackRayRegion(const btVector3& from, const btVector3& to,
                      const btBroadphaseRayCallback& callback, const btVector3& castMin,
                      const btVector3& castMax)
        : segment_(toEigen(from), toEigen(to), reachOf(callback, to - from, castMin, castMax)),
          from_(from),
          castMin_(castMin),
          castMax_(castMax),
          callback_(callback) {}

    [[nodiscard, HASHPHASE_ALWAYS_INLINE]] btScalar key(const Aabb<btScalar>& box) const {
        const btVector3 bounds[2] = {toBullet(box.min()) - castMax_,
                                     toBullet(box.max()) - castMin_};
        btScalar enter = 0;
        const bool isHit = btRayAabb2(from_, callback_.m_rayDirectionInverse, callback_.m_signs,
                                      bounds, enter, btScalar(0), callback_.m_lambda_max);
        if (!isHit || hasNan(box)) {
            return -1;
        }
        return enter > 0 ? enter / callback_.m_lambda_max : btScalar(0);
    }

    [[nodiscard]] const RayRegion<btScalar>& segment() const { return segment_; }

private:
    static Aabb<btScalar> reachOf(const btBroadphaseRayCallback& callback, const btVector3& way,
                                  const btVector3& castMin, const btVector3& castMax) {
        const btVector3 slack = slackOf(callback, way);
        return toAabb(castMin - slack, castMax + slack);
    }

    RayRegion<btScalar> segment_;
    const btVector3& from_;
    const btVector3& castMin_;
    const btVector3& castMax_;
    const btBroadphaseRayCallback& callback_;
};

/// The fields that btCollisionWorld::rayTest() gives its callback.
struct RayFields final : btBroadphaseRayCallback {
    RayFields(const btVector3& from, const btVector3& to) {
        const btVector3 way = to - from;
        const btVector3 direction = way * (btScalar(1) / way.length());
        for (int axis = 0; axis < 3; ++axis) {
            m_rayDirectionInverse[axis] =
                direction[axis] == 0 ? btScalar(BT_LARGE_FLOAT) : btScalar(1) / direction[axis];
            m_signs[axis] = m_rayDirectionInverse[axis] < 0 ? 1 : 0;
        }
        m_lambda_max = direction.dot(way);
    }
    bool process(const btBroadphaseProxy* /*proxy*/) override { return true; }
};

/// How much sooner than at an object's box its shape may be hit, as a fraction of the ray: Bullet's
/// convex casts end a centimetre before the surface, and round in the world's coordinates.
btScalar castTolerance(const btVector3& from, const btVector3& to) {
    constexpr auto surface = btScalar(0.02);  // [m]
    const btScalar reach = from.absolute().length() + to.absolute().length();
    const btScalar rounding = 64 * std::numeric_limits<btScalar>::epsilon() * reach;
    const btScalar length = (to - from).length();
    return length > 0 ? (surface + rounding) / length : btScalar(0);
}

/// Casts the ray at the shape of each object that it is offered, as long as a nearer hit is possible.
class ShapeCaster {
public:
    ShapeCaster(const SpatialHashBroadphase& broadphase, const btVector3& from, const btVector3& to,
                btCollisionWorld::RayResultCallback& callback)
        : broadphase_(broadphase),
          from_(from),
          to_(to),
          tolerance_(castTolerance(from, to)),
          callback_(callback) {}

    void add(ProxyId id, btScalar /*key*/) { castAtShape(broadphase_, id, from_, to_, callback_); }
    [[nodiscard]] btScalar limit() const {
        const btScalar closest = callback_.m_closestHitFraction;
        return closest > 0 ? closest + tolerance_ : btScalar(-1);
    }

private:
    const SpatialHashBroadphase& broadphase_;
    const btVector3& from_;
    const btVector3& to_;
    btScalar tolerance_;
    btCollisionWorld::RayResultCallback& callback_;
};

// Rays that a thread takes at a time.
constexpr std::size_t kRaysAtOnce = 32;

}  // namespace

/// Hands what a query finds to Bullet's callback.
template <class Callback>
struct SpatialHashBroadphase::ProcessCollector {
    const SpatialHashBroadphase& broadphase;
    Callback& callback;
    bool isStopped = false;

    void add(ProxyId id, btScalar /*key*/) {
        const bool goOn = callback.process(broadphase.proxyAt(id.index));
        isStopped = !goOn && broadphase.config_.stopWhenProcessReturnsFalse;
    }
    [[nodiscard]] double limit() const {
        return isStopped ? -1 : std::numeric_limits<double>::infinity();
    }
};

void SpatialHashBroadphase::rayTest(const btVector3& rayFrom, const btVector3& rayTo,
                                    btBroadphaseRayCallback& rayCallback, const btVector3& aabbMin,
                                    const btVector3& aabbMax) {
    static_cast<void>(endsRayTest(rayFrom, rayTo, rayCallback, aabbMin, aabbMax));
}

void SpatialHashBroadphase::rayTest(const btVector3& rayFrom, const btVector3& rayTo,
                                    btBroadphaseRayCallback& rayCallback, const btVector3& aabbMin,
                                    const btVector3& aabbMax) const {
    static_cast<void>(endsRayTest(rayFrom, rayTo, rayCallback, aabbMin, aabbMax));
}

bool SpatialHashBroadphase::endsRayTest(const btVector3& from, const btVector3& to,
                                        btBroadphaseRayCallback& callback, const btVector3& castMin,
                                        const btVector3& castMax) const {
    const CallbackRayRegion region(from, to, callback, castMin, castMax);
    ProcessCollector<btBroadphaseRayCallback> collector{*this, callback};
    grid_.visit(region, collector);
    return collector.isStopped;
}

void SpatialHashBroadphase::rayTests(std::span<const BroadphaseRay> rays, ParallelFor parallelFor) {
    grid_.expectRays(rays.size());
    parallelFor(rays.size(), kRaysAtOnce, [&](std::size_t begin, std::size_t end) {
        for (const BroadphaseRay& ray : rays.subspan(begin, end - begin)) {
            HASHPHASE_ASSERT(
                ray.callback != nullptr,
                "rayTests(): a ray has no callback. Set BroadphaseRay::callback of each ray.");
            rayTest(ray.from, ray.to, *ray.callback, ray.castMin, ray.castMax);
        }
    });
}

QueryCost SpatialHashBroadphase::closestRay(const btVector3& from, const btVector3& to,
                                            btCollisionWorld::RayResultCallback& callback) const {
    const btVector3 none(0, 0, 0);
    const RayFields fields(from, to);
    ShapeCaster caster(*this, from, to, callback);
    return caster.limit() >= 0
               ? grid_.visit(CallbackRayRegion(from, to, fields, none, none), caster)
               : QueryCost{};
}

void SpatialHashBroadphase::closestRays(std::span<const ClosestRay> rays,
                                        ParallelFor parallelFor) const {
    grid_.expectRays(rays.size());
    parallelFor(rays.size(), kRaysAtOnce, [&](std::size_t begin, std::size_t end) {
        for (const ClosestRay& ray : rays.subspan(begin, end - begin)) {
            HASHPHASE_ASSERT(
                ray.callback != nullptr,
                "closestRays(): a ray has no callback. Set ClosestRay::callback of each ray.");
            closestRay(ray.from, ray.to, *ray.callback);
        }
    });
}

void SpatialHashBroadphase::aabbTest(const btVector3& aabbMin, const btVector3& aabbMax,
                                     btBroadphaseAabbCallback& callback) {
    static_cast<void>(endsAabbTest(aabbMin, aabbMax, callback));
}

void SpatialHashBroadphase::aabbTest(const btVector3& aabbMin, const btVector3& aabbMax,
                                     btBroadphaseAabbCallback& callback) const {
    static_cast<void>(endsAabbTest(aabbMin, aabbMax, callback));
}

bool SpatialHashBroadphase::endsAabbTest(const btVector3& aabbMin, const btVector3& aabbMax,
                                         btBroadphaseAabbCallback& callback) const {
    ProcessCollector<btBroadphaseAabbCallback> collector{*this, callback};
    grid_.visit(BoxRegion<btScalar>{toAabb(aabbMin, aabbMax)}, collector);
    return collector.isStopped;
}

Aabb<btScalar> SpatialHashBroadphase::bounds() const {
    Aabb<btScalar> all;
    grid_.forEach([&](ProxyId /*id*/, const Aabb<btScalar>& box) {
        if (!hasNan(box)) {
            all.extend(box);
        }
    });
    return all;
}

void SpatialHashBroadphase::getBroadphaseAabb(btVector3& aabbMin, btVector3& aabbMax) const {
    const Aabb<btScalar> all = bounds();
    aabbMin = all.isEmpty() ? btVector3(0, 0, 0) : toBullet(all.min());
    aabbMax = all.isEmpty() ? btVector3(0, 0, 0) : toBullet(all.max());
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
