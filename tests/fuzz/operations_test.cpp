// SPDX-License-Identifier: Zlib

#include <tests/fuzz/property.hpp>

#include <gtest/gtest.h>

namespace hashphase::test {
namespace {

TEST(RandomOperations, LeaveAGridAndItsQueriesLikeALookAtEverything) {
    expectNoFaultInRandomLives(kGrid);
}

TEST(RandomOperations, LeavePairsAndSweepsLikeBruteForce) {
    expectNoFaultInRandomLives(kPairs);
}

TEST(RandomOperations, LeaveClientsOfTheGridLikeALookAtEverything) {
    expectNoFaultInRandomLives(kClients);
}

TEST(RandomOperations, FindWhoIsFartherAwayThanCellsAreNumbered) {
    expectNoFault(kGrid, {
                             {81, {0, 0, 0, 7, 1}},  // at 1e6, with cells of 1e-30
                             {181, {}},              // add a point
                             {109, {}},              // add another one there
                             {31, {189}},            // add 30 more
                             {62, {}},               // update
                             {45, {}},               // who is in the cell of the first?
                         });
}

TEST(FuzzCorpus, IsNoTroubleToTheGrid) {
    expectNoFaultInCorpus(kGrid);
}

TEST(FuzzCorpus, IsNoTroubleToPairs) {
    expectNoFaultInCorpus(kPairs);
}

TEST(FuzzCorpus, IsNoTroubleToTheClients) {
    expectNoFaultInCorpus(kClients);
}

}  // namespace
}  // namespace hashphase::test
