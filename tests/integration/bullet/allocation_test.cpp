// SPDX-License-Identifier: Zlib
//
// A frame like the last one takes no memory. Counts every `new` of this program, and what Bullet's
// own arrays take.

#include <tests/integration/bullet/bullet_scenes.hpp>

#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <LinearMath/btAlignedAllocator.h>

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>
#include <vector>

// Sanitizers have a `new` of their own, which finds faults that this one would hide.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define HASHPHASE_COUNTS_ALLOCATIONS 0
#else
#define HASHPHASE_COUNTS_ALLOCATIONS 1
#endif

#if HASHPHASE_COUNTS_ALLOCATIONS

namespace {

std::atomic<std::size_t> allocations{0};

void* allocate(std::size_t size) {
    ++allocations;
    return std::malloc(size);
}

}  // namespace

// Not inlined: compilers take free() for a mismatch where they see only one half of the pair.
[[gnu::noinline]] void* operator new(std::size_t size) {
    if (void* memory = allocate(size == 0 ? 1 : size)) {
        return memory;
    }
    throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
    ++allocations;
    const auto step = static_cast<std::size_t>(alignment);
    if (void* memory = std::aligned_alloc(step, (size + step - 1) / step * step)) {
        return memory;
    }
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}

namespace hashphase::test {
namespace {

/// Boxes that swing about where they began, each at its own pace; every fourth one stays there.
class Swing {
public:
    explicit Swing(int count) {
        Random random(1);
        const double half = std::cbrt(count) * 0.55;
        for (int object = 0; object < count; ++object) {
            homes_.push_back(boxAround(random.vector(-half, half), random.vector(0.3, 0.6)));
            paces_.push_back(random.vector(0.05, 0.1));
            proxies_.push_back(broadphase.createProxy(
                homes_.back().min, homes_.back().max, BOX_SHAPE_PROXYTYPE, nullptr,
                btBroadphaseProxy::DefaultFilter, btBroadphaseProxy::AllFilter, nullptr));
        }
    }

    ~Swing() {
        for (btBroadphaseProxy* proxy : proxies_) {
            broadphase.destroyProxy(proxy, nullptr);
        }
    }

    void frame(int number) {
        for (std::size_t object = 0; object < proxies_.size(); ++object) {
            if (object % 4 == 0) {
                continue;
            }
            const btVector3 angle = paces_[object] * btScalar(number);
            const btVector3 offset(btSin(angle.x()), btSin(angle.y()), btSin(angle.z()));
            broadphase.setAabb(proxies_[object], homes_[object].min + offset,
                               homes_[object].max + offset, nullptr);
        }
        broadphase.calculateOverlappingPairs(nullptr);
    }

    SpatialHashBroadphase broadphase;

private:
    std::vector<Box> homes_;
    std::vector<btVector3> paces_;
    std::vector<btBroadphaseProxy*> proxies_;
};

TEST(SteadyFrame, AllocatesNothing) {
    btAlignedAllocSetCustom(allocate, std::free);
    {
        Swing swing(4000);
        constexpr int kWarm = 400;
        for (int number = 0; number < kWarm; ++number) {
            swing.frame(number);
        }
        const std::size_t before = allocations;
        ASSERT_GT(before, 0U);
        std::uint64_t couplesWatched = 0;
        for (int number = kWarm; number < kWarm + 200; ++number) {
            swing.frame(number);
            couplesWatched += swing.broadphase.lastCost().couplesWatched;
        }
        EXPECT_EQ(allocations, before);
        EXPECT_GT(couplesWatched, 200U * 4000U);
        EXPECT_EQ(swing.broadphase.validate(), "");
    }
    btAlignedAllocSetCustom(nullptr, nullptr);
}

}  // namespace
}  // namespace hashphase::test

#endif
