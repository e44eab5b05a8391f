// SPDX-License-Identifier: Zlib
#include <demos/accuracy/sweeps/sweep_experiment.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace hashphase::demos {
namespace {

SweepPlan tinySweeps() {
    SweepPlan plan;
    plan.tunnelling = {{0.001, 0.1}, {0.3, 1, 3, 30}, 40};
    plan.bodyRounds = 1;
    plan.movers = {400, 40, {{3, 8}}, 2};
    return plan;
}

Findings measureWith(std::span<const SweepMethod> methods) {
    return measureSweeps(tinySweeps(), methods, 1, [](double, std::string_view) {});
}

std::vector<std::string> brokenClaims(std::span<const SweepMethod> methods) {
    std::vector<std::string> broken;
    for (const Check& check : measureWith(methods).checks) {
        if (!check.holds) {
            broken.push_back(check.claim);
        }
    }
    return broken;
}

/// Lists what another one does, but for every 50th pair, and as many that nobody has.
class CarelessFinder : public SweepFinder {
public:
    CarelessFinder(bool drops, std::unique_ptr<SweepFinder> careful)
        : drops_(drops), careful_(std::move(careful)) {}

    void step(const SweptFrame& frame) override { careful_->step(frame); }
    void listPairs(std::vector<PairKey>& pairs) const override {
        std::vector<PairKey> all;
        careful_->listPairs(all);
        for (const PairKey pair : all) {
            const bool isNext = ++listed_ % 50 == 0;
            if (!isNext || !drops_) {
                pairs.push_back(pair);
            }
            if (isNext && !drops_) {
                pairs.push_back(pairKey(0, 1'000'000));
            }
        }
    }

private:
    bool drops_;
    std::unique_ptr<SweepFinder> careful_;
    mutable int listed_ = 0;
};

SweepMethod careless(bool drops, SweepMethod method) {
    method.make = [drops, make = method.make](const SweptFrame& first) {
        return std::make_unique<CarelessFinder>(drops, make(first));
    };
    return method;
}

bool mentions(const std::vector<std::string>& claims, std::string_view words) {
    return std::any_of(claims.begin(), claims.end(), [&](const std::string& claim) {
        return claim.find(words) != std::string::npos;
    });
}

TEST(SweepExperiment, HoldsForEveryMethod) {
    const std::vector<SweepMethod> methods = sweepMethods();
    EXPECT_EQ(brokenClaims(methods), std::vector<std::string>{});
    const Findings findings = measureWith(methods);
    ASSERT_EQ(findings.charts.size(), 3U);
    for (const Chart& chart : findings.charts) {
        SCOPED_TRACE(chart.name);
        EXPECT_FALSE(chart.data.rows.empty());
        for (const std::string& column :
             {chart.x.column, chart.y.column, chart.series, chart.low, chart.high, chart.label}) {
            EXPECT_TRUE(column.empty() || chart.data.columnOf(column) < chart.data.columns.size());
        }
    }
    EXPECT_FALSE(findings.choices.empty());
    EXPECT_FALSE(findings.conclusions.empty());
}

TEST(SweepExperiment, NoticesASweepThatDropsEvery50thContact) {
    const std::vector methods{gridSweep(Sweep::none), gridSweep(Sweep::box),
                              careless(true, gridSweep(Sweep::line))};
    const std::vector<std::string> broken = brokenClaims(methods);
    EXPECT_EQ(broken.size(), 2U);
    EXPECT_TRUE(mentions(broken, "miss none"));
    EXPECT_TRUE(mentions(broken, "the same pairs"));
}

TEST(SweepExperiment, NoticesASweepThatInventsContacts) {
    const std::vector methods{gridSweep(Sweep::none), gridSweep(Sweep::box),
                              careless(false, gridSweep(Sweep::line))};
    const std::vector<std::string> broken = brokenClaims(methods);
    EXPECT_EQ(broken.size(), 2U);
    EXPECT_TRUE(mentions(broken, "list no other"));
}

TEST(SweepExperiment, NoticesASweepThatLooksAtTheEndAlone) {
    SweepMethod method = gridSweep(Sweep::none);
    method.missesNothing = true;
    EXPECT_TRUE(mentions(brokenClaims(std::vector{method}), "miss none"));
}

TEST(SweepExperiment, NoticesADiscreteMethodBesideTheTheory) {
    SweepMethod method = gridSweep(Sweep::automatic);
    method.isDiscrete = true;
    EXPECT_TRUE(mentions(brokenClaims(std::vector{method}), "lies on the line"));
}

TEST(SweepExperiment, NoticesTimesThatAreNotQuiteTrue) {
    SweepMethod method = gridSweep(Sweep::automatic);
    method.contactTime = [](const MovingBox<float>& a, const MovingBox<float>& b) {
        const std::optional<double> time = firstContact(a, b);
        return time ? std::optional(static_cast<double>(static_cast<float>(*time))) : time;
    };
    EXPECT_TRUE(mentions(brokenClaims(std::vector{gridSweep(Sweep::none), method}), "Times"));
}

TEST(SweepTruth, IsWhatOneComputesByHand) {
    SweptFrame frame;
    frame.movers = 1;
    const Vector3<float> one(1, 1, 1);
    frame.objects = {{{Vector3<float>(0, 0, 0), one}, Vector3<float>(8, 0, 0)},
                     {{Vector3<float>(4, 1, 0), Vector3<float>(5, 2, 1)}},     // at 3/8
                     {{Vector3<float>(4, 1.5F, 0), Vector3<float>(5, 2, 1)}},  // passed
                     {{Vector3<float>(9, 0, 0), Vector3<float>(10, 1, 1)}},    // at the last moment
                     {{Vector3<float>(-1, 0, 0), Vector3<float>(0, 1, 1)}}};   // at the first
    const SweepTruth truth = findTruth(frame);
    EXPECT_EQ(truth.contacts, (std::vector<PairKey>{pairKey(0, 1), pairKey(0, 3)}));
    EXPECT_EQ(truth.older, std::vector<PairKey>{pairKey(0, 4)});
    EXPECT_EQ(truth.moments[0].value(), 0.375);
    EXPECT_EQ(truth.moments[1].value(), 1.0);
    EXPECT_EQ(truth.moments[0].errorOf(0.5), 0.125);
    frame.objects[1].box.min().x() += 0x1p-12F;
    EXPECT_THROW(static_cast<void>(exactContact(frame, 0, 1)), std::logic_error);
}

}  // namespace
}  // namespace hashphase::demos
