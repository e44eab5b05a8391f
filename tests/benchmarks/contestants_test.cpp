// SPDX-License-Identifier: Zlib

// All contestants of this build, in a scene that is harder on what they remember than the benchmarks are.

#include <tests/benchmarks/measurement.hpp>
#include <tests/benchmarks/pair_workload.hpp>
#include <tests/demos/asked.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace hashphase::benchmarks {
namespace {

using demos::asked;

// Boxes on a lattice, so that many touch. A third is static. Other ones rest in each frame; static ones
// move in some, and in every fifth all rest.
class RestlessScene final : public demos::BoxScene {
public:
    RestlessScene(std::size_t objects, std::uint64_t seed) : random_(seed) {
        for (std::size_t i = 0; i < objects; ++i) {
            boxes_.push_back(drawBox());
            filters_.push_back(isStaticAt(i) ? demos::kStaticFilter : demos::CollisionFilter{});
        }
    }

    void advance() override {
        ++frame_;
        for (std::size_t i = 0; i < boxes_.size() && frame_ % 5 != 0; ++i) {
            const bool rests = (i + frame_) % 4 == 0 || (isStaticAt(i) && frame_ % 3 != 0);
            boxes_[i] = rests ? boxes_[i] : drawBox();
        }
    }
    [[nodiscard]] Aabb<float> bounds() const override {
        return boxBetween<float>({0, 0, 0}, {kRoom + 1, kRoom + 1, kRoom + 1});
    }

private:
    static constexpr float kRoom = 6;

    static bool isStaticAt(std::size_t object) { return object % 3 == 0; }

    Aabb<float> drawBox() {
        const auto draw = [this] { return 0.5F * std::floor(random_.between(0, 2 * kRoom)); };
        const Vector3<float> low(draw(), draw(), draw());
        return {low, low + Vector3<float>::Constant(random_.unit() < 0.5F ? 0.5F : 1)};
    }

    demos::Random random_;
    std::size_t frame_ = 0;
};

// Bullet's trees and FCL list others as well.
TEST(Contestants, ListThePairsOfBoxesThatRestMoveAndTouch) {
    const Benchmark benchmark{.name = "restless",
                              .make = makePairWorkload([](std::size_t objects, std::uint64_t seed) {
                                  return std::make_unique<RestlessScene>(objects, seed);
                              })};
    MeasurementSettings settings;
    settings.frames = 30;
    settings.warmUpFrames = 0;
    demos::Measurements measured;
    static_cast<void>(measure({&benchmark, 400, contestantKinds()}, settings, measured));
    const auto namesWith = [&measured](const std::string& condition) {
        return asked(
            measured,
            "SELECT name FROM contestants LEFT JOIN checks ON contestant = contestants.rowid "
            "GROUP BY name HAVING " +
                condition);
    };
    EXPECT_EQ(namesWith("count(*) <> 30 OR min(exact) < 100"), "");
    EXPECT_EQ(namesWith("sum(missing) + sum(duplicates) > 0"), "");
    EXPECT_EQ(namesWith("sum(extra) > 0 AND name NOT LIKE 'dbvt%' AND name NOT LIKE 'fcl-%'"), "");
}

}  // namespace
}  // namespace hashphase::benchmarks
