// SPDX-License-Identifier: Zlib

#include <broadphase/collectors.hpp>
#include <broadphase/proxy_filter.hpp>
#include <tests/support/query_checks.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class Collectors : public testing::Test {
protected:
    void SetUp() override {
        Random random(0x5eed0611);
        for (int i = 0; i < 500; ++i) {
            // On a lattice, so that many are as far away as others.
            const Vector3<double> corner = random.pointIn(0, 10).array().floor().matrix();
            const Aabb<Scalar> box(corner.template cast<Scalar>(),
                                   (corner.array() + 0.5).matrix().template cast<Scalar>());
            proxies_.push_back({grid_.add(box), box});
        }
        grid_.update();
    }

    Grid<Scalar> grid_;
    std::vector<Placed<Scalar>> proxies_;
    SphereRegion<Scalar> ball_{Vector3<Scalar>(5, 5, 5), 4};
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Collectors, Scalars);

TYPED_TEST(Collectors, OfTheNearestKeepTheFirstByDistanceThenById) {
    CollectKeys<TypeParam> all;
    visitByBruteForce<TypeParam>(this->proxies_, this->ball_, all);
    std::vector<KeyedProxy<TypeParam>> expected;
    for (const auto& [id, key] : all.sorted()) {
        expected.push_back({key, id});
    }
    std::sort(expected.begin(), expected.end());
    ASSERT_GT(expected.size(), 50U);
    std::vector<KeyedProxy<TypeParam>> nearest;
    for (const std::size_t count : {0U, 1U, 2U, 7U, 40U, 1000U}) {
        CollectNearest<TypeParam> collector(count, nearest);
        this->grid_.visit(this->ball_, collector);
        const auto sorted = collector.sort();
        const std::size_t least = std::min<std::size_t>(count, expected.size());
        EXPECT_TRUE(std::equal(sorted.begin(), sorted.end(), expected.begin(),
                               expected.begin() + static_cast<std::ptrdiff_t>(least)))
            << count;
    }
}

TYPED_TEST(Collectors, OfBitsSetOneForEachProxyFoundAndClearNone) {
    CollectKeys<TypeParam> all;
    this->grid_.visit(this->ball_, all);
    std::vector<std::uint64_t> bits{std::uint64_t{1} << 63};
    CollectBits collector(bits);
    this->grid_.visit(this->ball_, collector);
    std::vector<bool> expected(64 * bits.size());
    expected[63] = true;
    for (const auto& [id, key] : all.sorted()) {
        expected.at(id.index) = true;
    }
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ((bits[i / 64] >> (i % 64) & 1) != 0, expected[i]) << i;
    }
}

TYPED_TEST(Collectors, HearOnlyOfWhatAFilterAccepts) {
    const auto isEven = [](ProxyId id) { return id.index % 2 == 0; };
    std::vector<ProxyId> found;
    CollectAll all(found);
    CollectIf even(all, isEven);
    const QueryCost cost = this->grid_.visit(this->ball_, even);
    CollectCount count;
    this->grid_.visit(this->ball_, count);
    EXPECT_TRUE(std::all_of(found.begin(), found.end(), isEven));
    EXPECT_EQ(cost.hits, count.count());
    // A search for one goes on behind those that are refused.
    const ProxyId wanted = *std::max_element(found.begin(), found.end());
    CollectAny any;
    const auto isWanted = [wanted](ProxyId id) { return id == wanted; };
    CollectIf only(any, isWanted);
    this->grid_.visit(this->ball_, only);
    EXPECT_EQ(any.found(), wanted);
}

TYPED_TEST(Collectors, KeepAFilterThatWasMadeInPassing) {
    CollectCount count;
    CollectIf none(count, [refused = std::vector<int>(9, 1)](ProxyId id) {
        return refused[id.index % refused.size()] == 0;
    });
    EXPECT_GT(this->grid_.visit(this->ball_, none).hits, 50U);
    EXPECT_EQ(count.count(), 0U);
}

}  // namespace
}  // namespace hashphase::test
