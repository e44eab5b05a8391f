// SPDX-License-Identifier: Zlib
#include <broadphase/core/flat_set.hpp>
#include <tests/support/random_keys.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <unordered_set>
#include <utility>
#include <vector>

namespace hashphase::detail {
namespace {

using test::randomKey;

TEST(FlatSet, NumbersItsKeysWithoutGaps) {
    FlatSet set;
    EXPECT_EQ(set.findOrInsert(30), 0U);
    EXPECT_EQ(set.findOrInsert(40), 1U);
    EXPECT_EQ(set.findOrInsert(50), 2U);
    EXPECT_EQ(set.findOrInsert(40), 1U);

    EXPECT_EQ(set.erase(30), 0U);
    EXPECT_EQ(set.find(50), 0U) << "the last key takes the number of the erased one";
    EXPECT_EQ(set.find(30), FlatSet::kNone);
    EXPECT_EQ(set.erase(30), FlatSet::kNone);
    EXPECT_EQ(set.size(), 2U);
    EXPECT_EQ(set.validate(), "");
}

TEST(FlatSet, LetsNewKeysTakeTheNumbersOfErasedOnes) {
    FlatSet set;
    for (std::uint64_t key = 0; key < 10; ++key) {
        set.findOrInsert(key);
    }
    EXPECT_EQ(set.vacate(3), 3U);
    EXPECT_EQ(set.vacate(5), 5U);
    EXPECT_EQ(set.vacate(8), 8U);
    EXPECT_EQ(set.vacate(5), FlatSet::kNone);
    EXPECT_EQ(set.find(5), FlatSet::kNone);
    EXPECT_EQ(set.insert(70, 5), 5U);
    EXPECT_EQ(set.insert(70, 8), 5U) << "it has a number";
    EXPECT_EQ(set.insert(0, 8), 0U);
    EXPECT_EQ(set.insert(90, 10), 10U);
    EXPECT_EQ(set.find(9), 9U) << "nobody else's number changes";
    set.fill(3);
    EXPECT_EQ(set.find(90), 3U) << "the last key takes the vacant number";
    EXPECT_EQ(set.find(9), 9U);
    set.fill(8);
    EXPECT_EQ(set.find(9), 8U);
    EXPECT_EQ(set.size(), 9U);
    EXPECT_EQ(set.validate(), "");
}

TEST(FlatSet, HasVacantNumbersTakenInAnyOrder) {
    FlatSet set;
    std::unordered_set<std::uint64_t> expected;
    std::mt19937_64 random(22);
    for (int round = 0; round < 300; ++round) {
        std::vector<std::uint32_t> vacant;
        for (std::uint64_t i = 0; i < random() % 40; ++i) {
            const std::uint64_t key = randomKey(random);
            const std::uint32_t number = set.vacate(key);
            ASSERT_EQ(number != FlatSet::kNone, expected.erase(key) == 1);
            if (number != FlatSet::kNone) {
                vacant.push_back(number);
            }
        }
        while (!vacant.empty()) {
            const std::uint64_t key = randomKey(random);
            const bool isNew = expected.insert(key).second;
            ASSERT_EQ(set.insert(key, vacant.back()) == vacant.back(), isNew);
            vacant.resize(vacant.size() - (isNew ? 1 : 0));
        }
        for (std::uint64_t i = 0; i < random() % 40; ++i) {
            const std::uint64_t key = randomKey(random);
            set.findOrInsert(key);
            expected.insert(key);
        }
        ASSERT_EQ(set.size(), expected.size());
        ASSERT_EQ(set.validate(), "") << round;
    }
}

TEST(FlatSet, RenumbersItsKeys) {
    FlatSet set;
    std::vector<std::uint64_t> follower;
    std::vector<std::uint32_t> newNumbers;
    constexpr std::uint32_t kCount = 1000;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        set.findOrInsert(7 * i);
        follower.push_back(7 * i);
        newNumbers.push_back((i * 37 + 5) % kCount);
    }
    set.renumber(newNumbers,
                 [&](std::uint32_t i, std::uint32_t j) { std::swap(follower[i], follower[j]); });
    for (std::uint32_t i = 0; i < kCount; ++i) {
        EXPECT_EQ(set.find(7 * i), (i * 37 + 5) % kCount);
        EXPECT_EQ(set.keys()[i], follower[i]);
    }
    EXPECT_EQ(set.validate(), "");
}

TEST(FlatSet, DoesNotClusterRegularKeys) {
    // A random function gives some 7 to 17 in a table as full as these can be.
    constexpr std::size_t kLongestProbe = 30;
    constexpr std::uint64_t kCount = 73000;
    const auto longestProbe = [&](auto&& keyOf) {
        FlatSet set;
        for (std::uint64_t i = 0; i < kCount; ++i) {
            set.findOrInsert(keyOf(i));
        }
        EXPECT_EQ(set.size(), kCount);
        return set.longestProbe();
    };
    for (unsigned shift = 0; shift <= 47; ++shift) {
        EXPECT_LE(longestProbe([=](std::uint64_t i) { return i << shift; }), kLongestProbe)
            << shift;
    }
    // 1802 and 2263 are bad for plain multiplication by the constants of the hash.
    for (std::uint64_t m : {1, 2, 3, 7, 31, 100, 256, 257, 1802, 2263, 65535, 65536, 65537}) {
        EXPECT_LE(longestProbe([=](std::uint64_t i) { return i * m; }), kLongestProbe) << m;
        EXPECT_LE(longestProbe([=](std::uint64_t i) { return i * m << 32 | (i + 1) * m; }),
                  kLongestProbe)
            << m << " apart, each with the next";
        EXPECT_LE(longestProbe([=](std::uint64_t i) { return i / m << 32 | (i % m + 1) << 8; }),
                  kLongestProbe)
            << m << " partners each";
    }
}

TEST(FlatSet, AgreesWithUnorderedSetOverRandomOperations) {
    FlatSet set;
    std::unordered_set<std::uint64_t> expected;
    std::mt19937_64 random(20);
    for (std::uint32_t i = 0; i < 100000; ++i) {
        const std::uint64_t key = randomKey(random);
        ASSERT_EQ(set.find(key) != FlatSet::kNone, expected.count(key) == 1);
        if (random() % 2 == 0) {
            set.findOrInsert(key);
            expected.insert(key);
        } else {
            ASSERT_EQ(set.erase(key) != FlatSet::kNone, expected.erase(key) == 1);
        }
        if (i % 1000 == 0) {
            ASSERT_EQ(set.validate(), "");
            ASSERT_EQ(set.size(), expected.size());
        }
    }
    EXPECT_GT(expected.size(), 100U);
}

TEST(FlatSet, IsEmptyAfterClear) {
    FlatSet set;
    EXPECT_EQ(set.find(3), FlatSet::kNone);
    EXPECT_EQ(set.erase(3), FlatSet::kNone);
    for (std::uint64_t key = 0; key < 100; ++key) {
        set.findOrInsert(key);
    }
    set.clear();
    EXPECT_EQ(set.size(), 0U);
    EXPECT_EQ(set.find(3), FlatSet::kNone);
    EXPECT_EQ(set.findOrInsert(3), 0U);
    EXPECT_EQ(set.validate(), "");
}

TEST(FlatSet, AllocatesNothingOnceItsCapacityIsThere) {
    FlatSet set;
    set.reserve(5000);
    const std::size_t reserved = set.memoryBytes();
    for (std::uint64_t round = 0; round < 50; ++round) {
        for (std::uint64_t key = 0; key < 5000; ++key) {
            set.findOrInsert(round * 5000 + key);
        }
        for (std::uint64_t key = 0; key < 5000; ++key) {
            set.erase(round * 5000 + key);
        }
    }
    EXPECT_EQ(set.memoryBytes(), reserved);
    set.reserve(5001 * 5);
    EXPECT_GT(set.memoryBytes(), reserved);
}

}  // namespace
}  // namespace hashphase::detail
