// SPDX-License-Identifier: Zlib
//
// The filter by group and mask: Bullet's ray callbacks, of the same group and mask, are the judge.

#include <integration/bullet/group_filter.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <btBulletCollisionCommon.h>
#include <gtest/gtest.h>

#include <array>
#include <type_traits>

namespace hashphase::test {
namespace {

constexpr std::array<int, 6> kBits{0, 1, 2, 64, 1 | 64, btBroadphaseProxy::AllFilter};

using Asker = GroupFilter::Asker;
static_assert(std::is_constructible_v<GroupFilter, const SpatialHashBroadphase&, Asker>);
static_assert(!std::is_constructible_v<GroupFilter, SpatialHashBroadphase, Asker>);
// Two numbers might be in either order.
static_assert(!std::is_constructible_v<GroupFilter, const SpatialHashBroadphase&, int>);
static_assert(!std::is_constructible_v<GroupFilter, const SpatialHashBroadphase&, int, int>);

class GroupFilterTest : public testing::Test {
protected:
    GroupFilterTest()
        : proxy_(broadphase_.createProxy(btVector3(0, 0, 0), btVector3(1, 1, 1),
                                         BOX_SHAPE_PROXYTYPE, nullptr, 1, 1, nullptr)) {}
    ~GroupFilterTest() override { broadphase_.destroyProxy(proxy_, nullptr); }

    /// Counts the proxies' groups and masks that are accepted, and compares each with Bullet's word.
    int countAccepted(const GroupFilter& filter,
                      const btCollisionWorld::RayResultCallback& callback) {
        int accepted = 0;
        for (const int group : kBits) {
            for (const int mask : kBits) {
                proxy_->m_collisionFilterGroup = group;
                proxy_->m_collisionFilterMask = mask;
                const bool isAccepted = filter(SpatialHashBroadphase::idOf(proxy_));
                EXPECT_EQ(isAccepted, callback.needsCollision(proxy_)) << group << ' ' << mask;
                accepted += isAccepted ? 1 : 0;
            }
        }
        return accepted;
    }

    SpatialHashBroadphase broadphase_;
    btBroadphaseProxy* proxy_;
};

TEST_F(GroupFilterTest, AcceptsWhatARayOfTheSameGroupAndMaskMeets) {
    for (const int group : kBits) {
        for (const int mask : kBits) {
            SCOPED_TRACE(testing::Message() << "filter " << group << ' ' << mask);
            btCollisionWorld::AllHitsRayResultCallback callback(btVector3(0, 0, 0),
                                                                btVector3(1, 0, 0));
            callback.m_collisionFilterGroup = group;
            callback.m_collisionFilterMask = mask;
            const int accepted =
                countAccepted(GroupFilter(broadphase_, {.group = group, .mask = mask}), callback);
            EXPECT_EQ(accepted > 0, group != 0 && mask != 0);
        }
    }
}

TEST_F(GroupFilterTest, AsksForAllGroupsUnlessToldOtherwise) {
    btCollisionWorld::AllHitsRayResultCallback callback(btVector3(0, 0, 0), btVector3(1, 0, 0));
    callback.m_collisionFilterGroup = btBroadphaseProxy::AllFilter;
    callback.m_collisionFilterMask = 64;
    // Three groups have the bit 64, and five masks are not empty.
    EXPECT_EQ(countAccepted(GroupFilter(broadphase_, {.mask = 64}), callback), 15);
}

}  // namespace
}  // namespace hashphase::test
