// SPDX-License-Identifier: Zlib

#include <tests/fuzz/property.hpp>

#include <gtest/gtest.h>

namespace hashphase::test {
namespace {

TEST(RandomOperations, LeaveTheBroadphaseAndItsQueriesLikeBruteForce) {
    expectNoFaultInRandomLives(kBroadphase);
}

TEST(RandomOperations, LeaveThePairCacheLikeASetOfPairs) {
    expectNoFaultInRandomLives(kCache);
}

TEST(FuzzCorpus, IsNoTroubleToTheBroadphase) {
    expectNoFaultInCorpus(kBroadphase);
}

TEST(FuzzCorpus, IsNoTroubleToThePairCache) {
    expectNoFaultInCorpus(kCache);
}

}  // namespace
}  // namespace hashphase::test
