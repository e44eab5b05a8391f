// SPDX-License-Identifier: Zlib

// Small parts of the core, each against something slower.

#include <broadphase/core/flat_set.hpp>
#include <broadphase/core/key_parts.hpp>
#include <broadphase/core/limits.hpp>
#include <broadphase/core/radix_sort.hpp>
#include <broadphase/core/run_map.hpp>
#include <broadphase/core/stable_array.hpp>
#include <broadphase/hash/bucket_sort.hpp>
#include <broadphase/simd/kernel_types.hpp>
#include <broadphase/simd/tag_kernel.hpp>
#include <tests/support/random.hpp>
#include <tests/support/threaded_for.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <new>
#include <random>
#include <set>
#include <span>
#include <stdexcept>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

namespace hashphase::detail {
namespace {

TEST(RadixSort, SortsAsComparisonsDo) {
    test::Random random(0x5eed0601);
    std::vector<std::uint64_t> scratch;
    for (const std::uint32_t bound : {1U, 2U, 300U, 2048U, 2049U, 100'000U, 1U << 31, ~0U}) {
        for (const std::size_t count : {0U, 1U, 2U, 255U, 256U, 257U, 4095U, 4096U, 50'000U}) {
            std::vector<std::uint64_t> keys;
            for (std::size_t i = 0; i < count; ++i) {
                keys.push_back(std::uint64_t{random.below(bound)} << 32 | random.below(bound));
            }
            std::vector<std::uint64_t> expected = keys;
            std::sort(expected.begin(), expected.end());
            std::vector<std::uint64_t> onThreads = keys;
            radixSort(keys, bound, scratch);
            ASSERT_EQ(keys, expected) << count << " keys below " << bound;
            test::ThreadedFor threadedFor(3, count);
            radixSort(onThreads, bound, scratch, threadedFor);
            ASSERT_EQ(onThreads, expected) << count << " keys below " << bound;
        }
    }
}

TEST(BucketSort, SortsOnThreadsAsOnOne) {
    test::Random random(0x5eed0602);
    for (const std::uint32_t bucketCount : {1U, 31U, 500U, 100'000U}) {
        for (const std::size_t count : {1U, 2048U, 2049U, 30'000U}) {
            std::vector<std::uint32_t> wanted(count);
            for (std::uint32_t& bucket : wanted) {
                bucket = random.below(8) == 0 ? kNoBucket : random.below(bucketCount);
            }
            std::vector<std::uint32_t> starts(bucketCount + 1);
            std::vector<std::uint32_t> order;
            const auto sort = [&](ParallelFor parallelFor) {
                std::vector<std::uint32_t> buckets(count);
                std::vector<std::uint32_t> scratch;
                BucketSort sorting;
                sorting.count(
                    buckets, std::span(starts).first(bucketCount), scratch,
                    [&](std::size_t first, std::size_t last) {
                        std::copy(wanted.begin() + std::ptrdiff_t(first),
                                  wanted.begin() + std::ptrdiff_t(last),
                                  buckets.begin() + std::ptrdiff_t(first));
                    },
                    parallelFor);
                return sorting.sort(buckets, starts, scratch, order, parallelFor);
            };
            std::uint32_t most = 0;
            std::uint32_t place = 0;
            std::vector<std::uint32_t> expectedStarts;
            std::vector<std::vector<std::uint32_t>> boxesOf(bucketCount);
            for (std::uint32_t box = 0; box < count; ++box) {
                if (wanted[box] != kNoBucket) {
                    boxesOf[wanted[box]].push_back(box);
                }
            }
            std::vector<std::uint32_t> expectedOrder;
            for (const std::vector<std::uint32_t>& boxes : boxesOf) {
                expectedStarts.push_back(place);
                place += static_cast<std::uint32_t>(boxes.size());
                expectedOrder.insert(expectedOrder.end(), boxes.begin(), boxes.end());
                most = std::max(
                    most, &boxes == &boxesOf.back() ? 0 : static_cast<std::uint32_t>(boxes.size()));
            }
            expectedStarts.push_back(place);
            test::ThreadedFor threadedFor(3, count);
            for (const ParallelFor parallelFor :
                 {ParallelFor(serialFor), ParallelFor(threadedFor)}) {
                ASSERT_EQ(sort(parallelFor), most) << count << " boxes, " << bucketCount;
                ASSERT_EQ(starts, expectedStarts) << count << " boxes, " << bucketCount;
                ASSERT_EQ(order, expectedOrder) << count << " boxes, " << bucketCount;
            }
        }
    }
}

TEST(TagKernel, GivesTheSameBitsAsItsScalarTwin) {
    std::mt19937 random(5);
    struct alignas(16) Tags {
        std::array<unsigned char, 16> of{};
    } tags;
    std::uint32_t matches = 0;
    for (int i = 0; i < 100'000; ++i) {
        for (unsigned char& tag : tags.of) {
            tag = static_cast<unsigned char>(random() % 4 == 0 ? random() : 254 + random() % 4);
        }
        const auto wanted = static_cast<unsigned char>(254 + random() % 4);
        const std::uint32_t mask = tagMaskScalar(tags.of.data(), wanted);
        ASSERT_EQ(tagMask(tags.of.data(), wanted), mask);
        matches |= mask;
    }
    EXPECT_EQ(matches, 0xffffU);
}

TEST(StableArray, MovesNoElementWhenItGrows) {
    StableArray<int> array;
    EXPECT_EQ(array.capacity(), 0U);
    std::vector<int*> addresses;
    for (std::size_t i = 0; i < 1000; ++i) {
        array.reserve(i + 1);
        ASSERT_GE(array.capacity(), i + 1);
        addresses.push_back(array.at(i));
        ASSERT_EQ(*addresses.back(), 0);
        *addresses.back() = static_cast<int>(i);
    }
    for (std::size_t i = 0; i < 1000; ++i) {
        ASSERT_EQ(array.at(i), addresses[i]);
        ASSERT_EQ(*array.at(i), static_cast<int>(i));
    }
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(array.at(0)) % 64, 0U);
    EXPECT_GE(array.memoryBytes(), 1000 * sizeof(int));
    const std::size_t capacity = array.capacity();
    array.reserve(3);
    EXPECT_EQ(array.capacity(), capacity);
}

TEST(StableArray, BeginsSmallAndGivesBackItsEnd) {
    StableArray<int> array;
    array.reserve(1);
    EXPECT_LT(array.memoryBytes(), 256U);
    array.reserve(1000);
    const int* const first = array.at(0);
    *array.at(99) = 7;
    array.shrink(100);
    EXPECT_LT(array.memoryBytes(), 1024U);
    EXPECT_GE(array.capacity(), 100U);
    EXPECT_LT(array.capacity(), 200U);
    EXPECT_EQ(array.at(0), first);
    EXPECT_EQ(*array.at(99), 7);
    array.reserve(1000);
    EXPECT_EQ(*array.at(999), 0);
    array.shrink(0);
    EXPECT_EQ(array.capacity(), 0U);
    EXPECT_EQ(array.memoryBytes(), 0U);
    array.reserve(20);
    EXPECT_EQ(*array.at(19), 0);
}

TEST(Limits, AreReachedByWhatIsMoreAndNotByWhatIsAsMuch) {
    EXPECT_NO_THROW(checkCount(5, 5, ""));
    EXPECT_THROW(checkCount(6, 5, ""), std::length_error);
    EXPECT_THROW(checkCount(~std::size_t{0}, 5, ""), std::length_error);
}

// --- Sets of keys --------------------------------------------------------------------------------

// Few different keys, so that they meet again; some at both ends of the range.
std::uint64_t randomKey(std::mt19937_64& random) {
    const std::uint64_t small = random() % 700;
    return random() % 2 == 0 ? small << 32 | (small + 1) : ~std::uint64_t{0} - small;
}

TEST(FlatSet, NumbersItsKeysWithoutGaps) {
    FlatSet set;
    EXPECT_EQ(set.find(3), FlatSet::kNone);
    EXPECT_EQ(set.erase(3), FlatSet::kNone);
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
    set.clear();
    EXPECT_EQ(set.size(), 0U);
    EXPECT_EQ(set.find(40), FlatSet::kNone);
    EXPECT_EQ(set.findOrInsert(40), 0U);
    EXPECT_EQ(set.validate(), "");
    if (sizeof(std::size_t) > sizeof(std::uint32_t)) {
        constexpr auto kOneTooMany = static_cast<std::size_t>(std::uint64_t{1} << 32);
        EXPECT_THROW(set.reserve(kOneTooMany), std::length_error);
    } else {  // memory ends first
        EXPECT_ANY_THROW(set.reserve(~std::size_t{0}));
    }
    EXPECT_EQ(set.find(40), 0U);
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

TEST(FlatSet, AgreesWithUnorderedSetOverRandomOperations) {
    FlatSet set;
    std::unordered_set<std::uint64_t> expected;
    std::mt19937_64 random(20);
    for (int round = 0; round < 3000; ++round) {
        for (int i = 0; i < 30; ++i) {
            const std::uint64_t key = randomKey(random);
            ASSERT_EQ(set.find(key) != FlatSet::kNone, expected.contains(key));
            if (random() % 2 == 0) {
                set.findOrInsert(key);
                expected.insert(key);
            } else {
                ASSERT_EQ(set.erase(key) != FlatSet::kNone, expected.erase(key) == 1);
            }
        }
        // Some numbers become vacant, and are taken in any order.
        std::vector<std::uint32_t> vacant;
        for (std::uint64_t i = 0; round % 10 == 0 && i < random() % 40; ++i) {
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
        ASSERT_EQ(set.size(), expected.size());
        ASSERT_EQ(round % 10 == 0 ? set.validate() : "", "") << round;
    }
    EXPECT_GT(expected.size(), 100U);
}

// Does half of a loop, and has no memory for the rest.
void failingFor(std::size_t count, std::size_t /*grain*/, LoopBody body) {
    body(0, (count + 1) / 2);
    throw std::bad_alloc();
}

// Some of the keys are there, some are not, and some come twice. The set is as full as it may be, so that searches
// leave their parts.
TEST(FlatSet, DoesInPartsWhatItDoesOneByOne) {
    FlatSet set;
    set.reserve(FlatSet::kParts * 9);
    const std::size_t capacity = set.capacity();
    ASSERT_TRUE(set.isInParts());
    std::unordered_set<std::uint64_t> expected;
    std::mt19937_64 random(22);
    KeyParts parts;
    std::size_t elsewhereCount = 0;
    // Returns what find(i), or where it is elsewhere findAnywhere(i), has found.
    const auto search = [&](const std::vector<std::uint64_t>& keys, ParallelFor parallelFor,
                            const auto& find, const auto& findAnywhere) {
        parts.reserve(keys.size());
        const auto found = parts.search(
            keys.size(), parallelFor, [&](std::size_t i) { return keys[i]; }, [](std::size_t) {},
            find);
        for (std::size_t i = 0; i < keys.size(); ++i) {
            if (found[i] == KeyParts::kNotSearched) {
                ++elsewhereCount;
                found[i] = findAnywhere(i);
            }
        }
        return std::vector<std::uint32_t>(found.begin(), found.end());
    };
    for (int round = 0; round < 300; ++round) {
        test::ThreadedFor threadedFor(3, random());
        const std::array<ParallelFor, 3> loops{serialFor, failingFor, threadedFor};
        const ParallelFor parallelFor = loops[std::size_t(round) % 3];
        std::vector<std::uint64_t> keys(random() % 5000);
        std::ranges::generate(keys, [&] { return randomKey(random); });
        std::vector<std::uint32_t> numbers;
        const std::vector<std::uint32_t> vacated = search(
            keys, parallelFor, [&](std::size_t i) { return set.vacateInPart(keys[i]); },
            [&](std::size_t i) { return set.vacate(keys[i]); });
        for (std::size_t i = 0; i < keys.size(); ++i) {
            ASSERT_EQ(vacated[i] != FlatSet::kNone, expected.erase(keys[i]) == 1);
            if (vacated[i] != FlatSet::kNone) {
                numbers.push_back(vacated[i]);
            }
        }
        while (set.size() + 1 < capacity) {
            numbers.push_back(static_cast<std::uint32_t>(set.size()));
            set.addVacant(1);
        }
        keys.resize(numbers.size());
        std::ranges::generate(keys, [&] { return randomKey(random); });
        const std::vector<std::uint32_t> inserted = search(
            keys, parallelFor, [&](std::size_t i) { return set.insertInPart(keys[i], numbers[i]); },
            [&](std::size_t i) { return set.insert(keys[i], numbers[i]); });
        std::set<std::uint32_t, std::greater<>> left;
        for (std::size_t i = 0; i < keys.size(); ++i) {
            const bool isNew = expected.insert(keys[i]).second;
            ASSERT_EQ(inserted[i] == numbers[i], isNew);
            if (!isNew) {
                left.insert(numbers[i]);
            }
        }
        for (const std::uint32_t number : left) {
            set.fill(number);
        }
        ASSERT_EQ(set.validate(), "") << round;
        ASSERT_EQ(set.size(), expected.size());
        ASSERT_EQ(set.capacity(), capacity);
    }
    EXPECT_GT(elsewhereCount, 1000U);
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
    for (std::uint64_t m :
         {1U, 2U, 3U, 7U, 31U, 100U, 256U, 257U, 1802U, 2263U, 65535U, 65536U, 65537U}) {
        EXPECT_LE(longestProbe([=](std::uint64_t i) { return i * m; }), kLongestProbe) << m;
        EXPECT_LE(longestProbe([=](std::uint64_t i) { return i * m << 32 | (i + 1) * m; }),
                  kLongestProbe)
            << m << " apart, each with the next";
        EXPECT_LE(longestProbe([=](std::uint64_t i) { return i / m << 32 | (i % m + 1) << 8; }),
                  kLongestProbe)
            << m << " partners each";
    }
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
