// SPDX-License-Identifier: Zlib
#include <broadphase/simd/tag_kernel.hpp>

#include <gtest/gtest.h>

#include <array>
#include <random>

namespace hashphase::detail {
namespace {

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

}  // namespace
}  // namespace hashphase::detail
