// SPDX-License-Identifier: Zlib
#include <broadphase/core/run_map.hpp>
#include <tests/support/random_keys.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <unordered_map>

namespace hashphase::detail {
namespace {

using test::randomKey;

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
