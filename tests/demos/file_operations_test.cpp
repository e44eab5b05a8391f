// SPDX-License-Identifier: Zlib

#include <tests/fuzz/property.hpp>

#include <gtest/gtest.h>

namespace hashphase::test {
namespace {

TEST(RandomOperations, OnFilesAreReadAsTheyAreOrRefusedWithAPlace) {
    expectNoFaultInRandomLives(kFiles);
}

TEST(FuzzCorpus, IsNoTroubleToTheReadersOfFiles) {
    expectNoFaultInCorpus(kFiles);
}

}  // namespace
}  // namespace hashphase::test
