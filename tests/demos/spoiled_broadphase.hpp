// SPDX-License-Identifier: Zlib
#pragma once

#include <BulletCollision/BroadphaseCollision/btSimpleBroadphase.h>

#include <cstddef>
#include <vector>

namespace hashphase::demos {

/// Bullet's brute force with wrong pairs: what spoil() does to them, from frame 3 on.
class SpoiledBroadphase : public btSimpleBroadphase {
public:
    using btSimpleBroadphase::btSimpleBroadphase;

    btBroadphaseProxy* createProxy(const btVector3& low, const btVector3& high, int shapeType,
                                   void* client, int group, int mask,
                                   btDispatcher* dispatcher) override {
        proxies_.push_back(
            btSimpleBroadphase::createProxy(low, high, shapeType, client, group, mask, dispatcher));
        return proxies_.back();
    }

    void calculateOverlappingPairs(btDispatcher* dispatcher) override {
        btSimpleBroadphase::calculateOverlappingPairs(dispatcher);
        if (frame_++ >= 3) {
            spoil(dispatcher);
        }
    }

protected:
    virtual void spoil(btDispatcher* dispatcher) = 0;

    std::vector<btBroadphaseProxy*> proxies_;

private:
    int frame_ = 0;
};

}  // namespace hashphase::demos
