// SPDX-License-Identifier: Zlib
#include <demos/accuracy/sweeps/sweep_method.hpp>

#include <demos/compare/filled_broadphase.hpp>

#include <algorithm>
#include <array>

namespace hashphase::demos {
namespace {

const BroadphaseKind& dbvtKind() {
    const auto kinds = broadphaseKinds();
    return *std::find_if(kinds.begin(), kinds.end(),
                         [](const BroadphaseKind& each) { return each.name == "dbvt"; });
}

class BulletFinder : public SweepFinder {
public:
    BulletFinder(BulletSweep sweep, const SweptFrame& first)
        : sweep_(sweep),
          movers_(first.movers),
          broadphase_(dbvtKind(), {Aabb<float>(), first.objects.size()}) {
        for (std::uint32_t i = 0; i < first.objects.size(); ++i) {
            broadphase_.create(i, knownBox(first.objects[i]), {});
        }
    }

    void step(const SweptFrame& frame) override {
        for (std::uint32_t i = 0; i < frame.movers; ++i) {
            broadphase_.set(i, knownBox(frame.objects[i]));
        }
        broadphase_.findPairs();
        if (sweep_ == BulletSweep::unitedAndTested) {
            keepTouching(frame);
        }
    }

    void listPairs(std::vector<PairKey>& pairs) const override {
        if (sweep_ == BulletSweep::unitedAndTested) {
            pairs.insert(pairs.end(), touching_.begin(), touching_.end());
            return;
        }
        btOverlappingPairCache& cache = *broadphase_.broadphase().getOverlappingPairCache();
        for (int i = 0; i < cache.getNumOverlappingPairs(); ++i) {
            const btBroadphasePair& pair = cache.getOverlappingPairArrayPtr()[i];
            if (sweep_ == BulletSweep::united || overlapNow(pair)) {
                pairs.push_back(pairKey(FilledBroadphase::objectOf(*pair.m_pProxy0),
                                        FilledBroadphase::objectOf(*pair.m_pProxy1)));
            }
        }
    }

private:
    [[nodiscard]] static bool overlapNow(const btBroadphasePair& pair) {
        return TestAabbAgainstAabb2(pair.m_pProxy0->m_aabbMin, pair.m_pProxy0->m_aabbMax,
                                    pair.m_pProxy1->m_aabbMin, pair.m_pProxy1->m_aabbMax);
    }

    [[nodiscard]] BulletBox knownBox(const MovingBox<float>& moving) const {
        const Aabb<float> box = sweep_ == BulletSweep::discrete ? endBox(moving) : wayBox(moving);
        return {btVector3(box.min().x(), box.min().y(), box.min().z()),
                btVector3(box.max().x(), box.max().y(), box.max().z())};
    }

    void keepTouching(const SweptFrame& frame) {
        touching_.clear();
        btOverlappingPairCache& cache = *broadphase_.broadphase().getOverlappingPairCache();
        const int count = cache.getNumOverlappingPairs();
        const btBroadphasePair* listed = count > 0 ? cache.getOverlappingPairArrayPtr() : nullptr;
        for (int i = 0; i < count; ++i) {
            const std::uint32_t a = FilledBroadphase::objectOf(*listed[i].m_pProxy0);
            const std::uint32_t b = FilledBroadphase::objectOf(*listed[i].m_pProxy1);
            if (std::min(a, b) < movers_ && firstContact(frame.objects[a], frame.objects[b])) {
                touching_.push_back(pairKey(a, b));
            }
        }
    }

    BulletSweep sweep_;
    std::uint32_t movers_;
    FilledBroadphase broadphase_;
    std::vector<PairKey> touching_;
};

}  // namespace

SweepMethod bulletSweep(BulletSweep sweep) {
    constexpr std::array kNames{"btDbvtBroadphase, discrete", "btDbvtBroadphase, united",
                                "btDbvtBroadphase, united, tested"};
    SweepMethod method;
    method.name = kNames[static_cast<std::size_t>(sweep)];
    method.origin = SweepOrigin::bullet;
    method.missesNothing = sweep != BulletSweep::discrete;
    method.inventsNothing = sweep != BulletSweep::united;
    method.isDiscrete = sweep == BulletSweep::discrete;
    if (sweep == BulletSweep::unitedAndTested) {
        method.contactTime = firstContact<float>;
    }
    method.make = [sweep](const SweptFrame& first) {
        return std::make_unique<BulletFinder>(sweep, first);
    };
    return method;
}

}  // namespace hashphase::demos
