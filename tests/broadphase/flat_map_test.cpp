// SPDX-License-Identifier: Zlib
#include <broadphase/detail/flat_map.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <unordered_map>
#include <utility>
#include <vector>

namespace hashphase::detail {
namespace {

constexpr std::uint64_t kLargest = ~std::uint64_t{0};

// Few different keys, so that they meet again; some at both ends of the range.
std::uint64_t randomKey(std::mt19937_64& random) {
    const std::uint64_t small = random() % 700;
    return random() % 2 == 0 ? small << 32 | (small + 1) : kLargest - small;
}

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
    // A random function gives some 60 to 130 in tables as full as these.
    constexpr std::size_t kLongestProbe = 200;
    constexpr std::uint64_t kCount = 80000;
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
    for (std::uint64_t m : {1, 2, 3, 7, 31, 100, 255, 256, 257, 1000, 65535, 65536, 65537}) {
        EXPECT_LE(longestProbe([=](std::uint64_t i) { return i * m; }), kLongestProbe) << m;
        EXPECT_LE(longestProbe([=](std::uint64_t i) { return i * m << 32 | (i + 1) * m; }),
                  kLongestProbe)
            << m << " apart, each with the next";
        EXPECT_LE(longestProbe([=](std::uint64_t i) { return i / m << 32 | (i % m + 1) << 8; }),
                  kLongestProbe)
            << m << " partners each";
    }
}

TEST(FlatMap, AgreesWithUnorderedMapOverRandomOperations) {
    FlatMap map;
    std::unordered_map<std::uint64_t, std::uint32_t> expected;
    std::mt19937_64 random(20);
    for (std::uint32_t i = 0; i < 100000; ++i) {
        const std::uint64_t key = randomKey(random);
        const auto known = expected.find(key);
        switch (random() % 4) {
            case 0:
                if (known == expected.end()) {
                    map.insert(key, i);
                    expected.emplace(key, i);
                }
                break;
            case 1:
                ASSERT_EQ(map.findOrInsert(key, i), expected.try_emplace(key, i).first->second);
                break;
            default: {
                const auto erased = map.erase(key);
                ASSERT_EQ(erased.has_value(), known != expected.end());
                if (erased) {
                    ASSERT_EQ(*erased, known->second);
                    expected.erase(known);
                }
            }
        }
        if (i % 1000 == 0) {
            ASSERT_EQ(map.validate(), "");
            ASSERT_EQ(map.size(), expected.size());
            map.forEach([&](std::uint64_t k, std::uint32_t value) {
                ASSERT_EQ(expected.at(k), value);
                ASSERT_EQ(*map.find(k), value);
            });
        }
    }
    EXPECT_GT(expected.size(), 100U);
}

TEST(FlatMap, IsEmptyAfterClear) {
    FlatMap map;
    EXPECT_EQ(map.find(3), nullptr);
    EXPECT_FALSE(map.erase(3));
    for (std::uint64_t key = 0; key < 100; ++key) {
        map.insert(key, 1);
    }
    map.clear();
    EXPECT_EQ(map.size(), 0U);
    EXPECT_EQ(map.find(3), nullptr);
    map.insert(3, 4);
    EXPECT_EQ(*map.find(3), 4U);
    EXPECT_EQ(map.validate(), "");
}

TEST(FlatMap, AllocatesNothingOnceItsCapacityIsThere) {
    FlatMap map;
    map.reserve(5000);
    const std::size_t reserved = map.memoryBytes();
    for (std::uint64_t round = 0; round < 50; ++round) {
        for (std::uint64_t key = 0; key < 5000; ++key) {
            map.insert(round * 5000 + key, 0);
        }
        for (std::uint64_t key = 0; key < 5000; ++key) {
            map.erase(round * 5000 + key);
        }
    }
    EXPECT_EQ(map.memoryBytes(), reserved);
    map.reserve(5001 * 5);
    EXPECT_GT(map.memoryBytes(), reserved);
}

TEST(RunMap, AgreesWithUnorderedMapOverRandomOperations) {
    RunMap map;
    std::unordered_map<std::uint64_t, std::uint32_t> expected;
    std::mt19937_64 random(21);
    for (std::uint32_t i = 0; i < 100000; ++i) {
        const std::uint64_t key = randomKey(random);
        const auto known = expected.find(key);
        const std::uint32_t value = random() % 2 == 0 ? i : RunMap::kNone;
        ASSERT_EQ(map.exchange(key, value),
                  known == expected.end() ? RunMap::kNone : known->second);
        if (value == RunMap::kNone) {
            expected.erase(key);
        } else {
            expected[key] = value;
        }
        if (i % 1000 == 0) {
            ASSERT_EQ(map.validate(), "");
            std::size_t count = 0;
            map.forEach([&](std::uint64_t k, std::uint32_t v) {
                ASSERT_EQ(expected.at(k), v);
                ASSERT_EQ(map.find(k), v);
                ++count;
            });
            ASSERT_EQ(count, expected.size());
        }
    }
    EXPECT_GT(expected.size(), 100U);
    map.clear();
    EXPECT_EQ(map.find(expected.begin()->first), RunMap::kNone);
}

}  // namespace
}  // namespace hashphase::detail
