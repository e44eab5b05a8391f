// SPDX-License-Identifier: Zlib
#include <demos/accuracy/culling/culling_experiment.hpp>
#include <demos/accuracy/culling/exact_frustum.hpp>

#include <gtest/gtest.h>

namespace hashphase::demos {
namespace {

const CullingPlan kTinyCulling{.objects = 300, .touching = 20, .flights = 1, .frames = 2};

// Another one's work, but for some objects.
class ForgetfulCulling final : public Culling {
public:
    explicit ForgetfulCulling(std::unique_ptr<Culling> inner) : inner_(std::move(inner)) {}

    CullingCost look(const CameraView& view) override { return inner_->look(view); }
    [[nodiscard]] bool draws(std::uint32_t object) const override {
        return object % 8 != 0 && inner_->draws(object);
    }

private:
    std::unique_ptr<Culling> inner_;
};

class Everything final : public Culling {
public:
    CullingCost look(const CameraView& /*view*/) override { return {}; }
    [[nodiscard]] bool draws(std::uint32_t /*object*/) const override { return true; }
};

Findings findWith(CullingMethod method) {
    return findCulling(kTinyCulling, 1, std::span(&method, 1), [](double, std::string_view) {});
}

CullingMethod exactMethod() {
    for (CullingMethod& each : gridCullingMethods()) {
        if (each.mustBeExact) {
            return each;
        }
    }
    return {};
}

TEST(CullingExperiment, FindsThatNoMethodOfOursLosesAnything) {
    const Findings findings =
        findCulling(kTinyCulling, 1, cullingMethods(), [](double, std::string_view) {});
    ASSERT_GE(findings.checks.size(), 13U);
    for (const Check& check : findings.checks) {
        EXPECT_TRUE(check.holds) << check.claim << ": " << check.evidence;
    }
    EXPECT_FALSE(findings.choices.empty());
    EXPECT_FALSE(findings.conclusions.empty());
}

TEST(CullingExperiment, NoticesAVisibleObjectThatIsNotDrawn) {
    CullingMethod method = exactMethod();
    method.make = [make = method.make](const CullingScene& scene) {
        return std::make_unique<ForgetfulCulling>(make(scene));
    };
    const Findings findings = findWith(method);
    ASSERT_EQ(findings.checks.size(), 3U);
    EXPECT_FALSE(findings.checks[0].holds);
    EXPECT_FALSE(findings.checks[1].holds);
    EXPECT_TRUE(findings.checks[2].holds);
}

TEST(CullingExperiment, NoticesAnExactMethodThatDrawsInVain) {
    CullingMethod method = exactMethod();
    method.make = [](const CullingScene&) { return std::make_unique<Everything>(); };
    const Findings findings = findWith(method);
    ASSERT_EQ(findings.checks.size(), 3U);
    EXPECT_TRUE(findings.checks[0].holds);
    EXPECT_TRUE(findings.checks[1].holds);
    EXPECT_FALSE(findings.checks[2].holds);
}

// The camera stands at the origin and looks along -z, 90 degrees high.
TEST(ExactFrustum, SeesWhatTouchesTheViewAndNoMore) {
    CameraPose pose;
    pose.fieldOfView = 1.5707963F;
    const ExactFrustum frustum(cameraView(pose));
    const auto box = [](Vector3<float> low, Vector3<float> high) { return Aabb<float>(low, high); };
    EXPECT_TRUE(frustum.sees(box({-1, -1, -12}, {1, 1, -10})));            // wholly inside
    EXPECT_TRUE(frustum.sees(box({-900, -900, -900}, {900, 900, 900})));   // all around
    EXPECT_TRUE(frustum.sees(box({-900, -0.5F, -11}, {900, 0.5F, -10})));  // across
    EXPECT_TRUE(frustum.sees(box({-1, 9.99F, -10}, {1, 20, -9})));         // over the upper edge
    EXPECT_FALSE(frustum.sees(box({-1, 10.01F, -10}, {1, 20, -9})));       // just above
    EXPECT_FALSE(frustum.sees(box({-1, -1, 1}, {1, 1, 2})));               // behind
    EXPECT_FALSE(frustum.sees(box({-1, -1, -500}, {1, 1, -401})));         // too far
    // Near the corner of the upper and the far plane, which none of them alone has outside.
    EXPECT_FALSE(frustum.sees(box({-900, 450, -900}, {-600, 800, -350})));
}

}  // namespace
}  // namespace hashphase::demos
