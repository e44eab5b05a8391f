// SPDX-License-Identifier: Zlib
#include <broadphase/core/stable_array.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace hashphase::detail {
namespace {

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

}  // namespace
}  // namespace hashphase::detail
