// SPDX-License-Identifier: Zlib
//
// The hard cases of `hashphase stability`, with our broadphase by Bullet's interface, in its precision, and
// random operations.

#include <demos/stability/bullet_subject.hpp>
#include <tests/fuzz/property.hpp>
#include <tests/support/hard_case_check.hpp>

#include <integration/bullet/spatial_hash_broadphase.hpp>

namespace hashphase::test {
namespace {

class HardCases : public testing::TestWithParam<demos::HardCase> {};

TEST_P(HardCases, HoldByBulletsInterface) {
    demos::CaseRun<btScalar> run;
    run.make = [](const demos::SubjectNeeds<btScalar>& needs) {
        SpatialHashConfig config;
        config.grid = needs.grid;
        return std::make_unique<demos::BulletSubject>(
            std::make_unique<SpatialHashBroadphase>(nullptr, config), needs.objects, true);
    };
    run.name = "hash";
    expectHolds<btScalar>(GetParam(), std::move(run));
}

INSTANTIATE_TEST_SUITE_P(Bullet, HardCases, testing::ValuesIn(demos::hardCases()), nameOfCase);

TEST(RandomOperations, LeaveTheBroadphaseAndItsQueriesLikeBruteForce) {
    expectNoFaultInRandomLives(kBroadphase);
    expectNoFaultInCorpus(kBroadphase);
}

TEST(RandomOperations, LeaveThePairCacheLikeASetOfPairs) {
    expectNoFaultInRandomLives(kCache);
    expectNoFaultInCorpus(kCache);
}

}  // namespace
}  // namespace hashphase::test
