// SPDX-License-Identifier: Zlib

// A broadphase over a pair cache of Bullet's, in which the end of a contact destroys a proxy: whichever it is, at
// whichever of the ends, and whatever has ended them.

#include <tests/integration/bullet/boxes.hpp>
#include <tests/integration/bullet/cache_side.hpp>

#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <set>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

/// Four boxes that all overlap, of which the first to end a contact for the `when`-th time takes `victim` along.
struct EndsInOtherCache {
    EndsInOtherCache(const CacheKind& kind, std::size_t takenAlong, std::size_t when)
        : boxes(kind.make()), victim(takenAlong), at(when) {
        for (const double x : {0.0, 0.5, 0.6, 0.7}) {
            all.push_back(boxes.create(cubeAt(btScalar(x))));
        }
        boxes.step();
        btBroadphasePairArray& pairs = boxes.pairCache().getOverlappingPairArray();
        for (int i = 0; i < pairs.size(); ++i) {
            void* const memory = dispatcher.allocateCollisionAlgorithm(sizeof(NotedAlgorithm));
            pairs[i].m_algorithm = new (memory) NotedAlgorithm(uidsOf(pairs[i]), freed, onFreed);
        }
    }
    void destroy(std::size_t which) {
        boxes.over->destroyProxy(all[which], &dispatcher);
        std::erase(boxes.proxies, all[which]);
        gone.insert(which);
    }
    /// Contacts have ended once, of pairs of these and of who is gone.
    void expectEnded(std::size_t leaver) {
        std::sort(freed.begin(), freed.end());
        EXPECT_EQ(std::adjacent_find(freed.begin(), freed.end()), freed.end()) << "freed twice";
        btBroadphasePairArray& pairs = boxes.pairCache().getOverlappingPairArray();
        for (std::size_t a = 0; a < 4; ++a) {
            for (std::size_t b = a + 1; b < 4; ++b) {
                const Uids uids(static_cast<int>(a) + 1, static_cast<int>(b) + 1);
                const bool isOfGone = gone.contains(a) || gone.contains(b);
                const bool hasEnded = isOfGone || a == leaver || b == leaver;
                EXPECT_EQ(std::count(freed.begin(), freed.end(), uids), hasEnded ? 1 : 0);
                int kept = 0;
                for (int i = 0; i < pairs.size(); ++i) {
                    kept += uidsOf(pairs[i]) == uids ? 1 : 0;
                }
                EXPECT_LE(kept, isOfGone ? 0 : 1);
                EXPECT_GE(kept, hasEnded ? 0 : 1);
            }
        }
        for (int i = 0; i < pairs.size(); ++i) {
            boxes.pairCache().cleanOverlappingPair(pairs[i], &dispatcher);
        }
        EXPECT_EQ(freed.size(), 6U);
        boxes.over->calculateOverlappingPairs(&dispatcher);
        EXPECT_EQ(boxes.hash().validate(), "");
    }

    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    std::vector<Uids> freed;
    const NotedAlgorithm::Act onFreed = [this](const Uids& /*ended*/) {
        if (freed.size() == at) {
            destroy(victim);
        }
    };
    AnyBoxes boxes;
    std::vector<btBroadphaseProxy*> all;
    std::set<std::size_t> gone;
    std::size_t victim;
    std::size_t at;
};

class OtherCaches : public testing::TestWithParam<CacheKind> {
protected:
    /// Ends contacts of each of the boxes, while each other box goes at each of the ends.
    template <class End>
    void forEachCase(const End& end) {
        for (std::size_t leaver = 0; leaver < 4; ++leaver) {
            for (std::size_t victim = 0; victim < 4; ++victim) {
                for (std::size_t at = 1; at <= 3 && victim != leaver; ++at) {
                    SCOPED_TRACE(testing::Message() << leaver << " " << victim << " " << at);
                    EndsInOtherCache ends(GetParam(), victim, at);
                    end(ends, leaver);
                    EXPECT_TRUE(ends.gone.contains(victim));
                    ends.expectEnded(leaver);
                }
            }
        }
    }
};

TEST_P(OtherCaches, StandThatAnEndDestroysAProxyWhileAnotherIsDestroyed) {
    forEachCase([](EndsInOtherCache& ends, std::size_t leaver) { ends.destroy(leaver); });
}

TEST_P(OtherCaches, StandThatAnEndDestroysAProxyWhileAnotherLeaves) {
    forEachCase([](EndsInOtherCache& ends, std::size_t leaver) {
        ends.boxes.set(ends.all[leaver], cubeAt(50));
        ends.boxes.over->calculateOverlappingPairs(&ends.dispatcher);
    });
}

TEST_P(OtherCaches, StandThatAnEndDestroysAProxyWhileTheShapeOfAnotherChanges) {
    forEachCase([](EndsInOtherCache& ends, std::size_t leaver) {
        ends.boxes.hash().shapeChanged(ends.all[leaver], &ends.dispatcher);
    });
}

INSTANTIATE_TEST_SUITE_P(OfBullet, OtherCaches, testing::Values(kCacheKinds[3], kCacheKinds[4]),
                         [](const auto& kind) { return kind.param.name; });

}  // namespace
}  // namespace hashphase::test
