// SPDX-License-Identifier: Zlib
#include <demos/accuracy/origin/origin_experiment.hpp>
#include <tests/demos/accuracy/findings_checks.hpp>

#include <BulletCollision/BroadphaseCollision/btSimpleBroadphase.h>

#include <gtest/gtest.h>

#include <algorithm>

namespace hashphase::demos {
namespace {

Findings findWith(const std::vector<OriginMethod>& methods,
                  const std::vector<SettleMethod>& settling) {
    return findOrigin({{0, 0x1p20, 0x1p30}, 150, 20}, 1, methods, settling, ignoreProgress);
}

bool isBroken(const Findings& findings, std::string_view claim) {
    const std::vector<std::string> broken = brokenClaims(findings);
    return std::any_of(broken.begin(), broken.end(),
                       [claim](const std::string& each) { return each.starts_with(claim); });
}

/// Another one's world, but the last pair and the last hit are lost.
class Lossy final : public OriginWorld {
public:
    explicit Lossy(std::unique_ptr<OriginWorld> world) : world_(std::move(world)) {}

    void set(std::span<const WorldBox> boxes) override { world_->set(boxes); }
    void listPairs(std::vector<PairKey>& pairs) override {
        world_->listPairs(pairs);
        pairs.pop_back();
    }
    void listHits(const WorldRay& ray, std::vector<std::uint32_t>& boxes) override {
        world_->listHits(ray, boxes);
        if (!boxes.empty()) {
            boxes.pop_back();
        }
    }

private:
    std::unique_ptr<OriginWorld> world_;
};

/// Bodies fall through each other.
class Blind final : public btSimpleBroadphase {
public:
    explicit Blind(btOverlappingPairCache* cache) : btSimpleBroadphase(100, cache) {}
    void calculateOverlappingPairs(btDispatcher* /*dispatcher*/) override {}
};

TEST(OriginExperiment, FindsTheSamePairsAtAnyDistance) {
    const Findings findings = findWith(originMethods(), settleMethods());
    EXPECT_EQ(brokenClaims(findings), std::vector<std::string>{});
    EXPECT_EQ(findings.checks.size(), 13U);
    EXPECT_EQ(findings.charts.size(), 5U);
    expectChartsCanBeDrawn(findings);
    EXPECT_EQ(findings.choices.size(), 15U);
    EXPECT_EQ(findings.conclusions.size(), 10U);
}

TEST(OriginExperiment, NoticesALostPairAndALostHit) {
    std::vector<OriginMethod> methods = originMethods();
    std::erase_if(methods, [](const OriginMethod& method) { return !method.isExact; });
    methods.front().make = [make = methods.front().make] {
        return std::make_unique<Lossy>(make());
    };
    methods.front().name = "lossy";
    const Findings findings = findWith(methods, settleMethods());
    EXPECT_TRUE(isBroken(findings, "lossy finds the same pairs at every distance ("));
    EXPECT_TRUE(isBroken(findings, "lossy misses no hit"));
    EXPECT_TRUE(isBroken(findings, "lossy finds the same pairs at every distance where"));
    EXPECT_FALSE(isBroken(findings, methods.back().name));
}

TEST(OriginExperiment, NoticesBallsThatRestElsewhereFarAway) {
    std::vector<SettleMethod> settling = settleMethods();
    settling.back().broadphase.make =
        [number = 0, make = settling.back().broadphase.make](PairCache* cache) mutable {
            return ++number == 1 ? make(cache) : std::make_unique<Blind>(cache);
        };
    EXPECT_TRUE(isBroken(findWith(originMethods(), settling), settling.back().name));
}

TEST(OriginScene, TellsExactlyWhetherARayMeetsABox) {
    const IntegerBox box{{0, 0, 0}, {2, 2, 2}};
    EXPECT_TRUE(meetExactly({{-5, 0, 0}, {5, 0, 0}}, box));
    EXPECT_TRUE(meetExactly({{-5, 2, 2}, {5, 2, 2}}, box));   // along an edge
    EXPECT_TRUE(meetExactly({{0, 4, 0}, {4, 0, 0}}, box));    // through an edge, at (2, 2, 0)
    EXPECT_FALSE(meetExactly({{0, 5, 0}, {4, 0, 0}}, box));   // past it
    EXPECT_TRUE(meetExactly({{-5, 0, 0}, {-2, 0, 0}}, box));  // ends on a face
    EXPECT_FALSE(meetExactly({{-5, 0, 0}, {-3, 0, 0}}, box));
    EXPECT_TRUE(meetExactly({{1, 1, 1}, {1, 1, 1}}, box));
    EXPECT_FALSE(meetExactly({{3, 1, 1}, {3, 1, 1}}, box));
}

}  // namespace
}  // namespace hashphase::demos
