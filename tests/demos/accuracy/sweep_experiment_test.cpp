// SPDX-License-Identifier: Zlib
#include <demos/accuracy/sweeps/sweep_experiment.hpp>
#include <tests/demos/accuracy/findings_checks.hpp>

#include <gtest/gtest.h>

#include <algorithm>

namespace hashphase::demos {
namespace {

Findings findWith(std::span<const SweepMethod> methods) {
    const SweepPlan plan{{0.001, 0.1}, {0.3, 1, 3, 30}, 40, 1, 400, 40, {{3, 8}}, 2};
    return findSweeps(plan, 1, methods, ignoreProgress);
}

SweepMethod named(std::string_view name) {
    const std::vector<SweepMethod> all = sweepMethods();
    return *std::find_if(all.begin(), all.end(),
                         [name](const SweepMethod& each) { return each.name == name; });
}

/// Lists what another one does, but for every 50th pair, or as many that nobody has.
class CarelessFinder final : public SweepFinder {
public:
    CarelessFinder(bool drops, std::unique_ptr<SweepFinder> careful)
        : drops_(drops), careful_(std::move(careful)) {}

    void step(const SweptFrame& frame) override { careful_->step(frame); }
    std::optional<SweepWork> listPairs(std::vector<PairKey>& pairs) const override {
        std::vector<PairKey> all;
        const std::optional<SweepWork> work = careful_->listPairs(all);
        for (const PairKey pair : all) {
            const bool isNext = ++listed_ % 50 == 0;
            if (!isNext || !drops_) {
                pairs.push_back(pair);
            }
            if (isNext && !drops_) {
                pairs.push_back(pairKey(0, 1'000'000));
            }
        }
        return work;
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

/// Of the claims that do not hold, those that have none of the words.
std::vector<std::string> unexpectedClaims(std::span<const SweepMethod> methods,
                                          std::initializer_list<std::string_view> words) {
    std::vector<std::string> broken = brokenClaims(findWith(methods));
    for (const std::string_view each : words) {
        if (std::erase_if(broken, [&](const std::string& claim) {
                return claim.find(each) != std::string::npos;
            }) == 0) {
            broken.push_back("Nothing broken has the words: " + std::string(each));
        }
    }
    return broken;
}

TEST(SweepExperiment, HoldsForEveryMethod) {
    const Findings findings = findWith(sweepMethods());
    EXPECT_EQ(brokenClaims(findings), std::vector<std::string>{});
    EXPECT_EQ(findings.checks.size(), 5U);
    EXPECT_EQ(findings.charts.size(), 3U);
    expectChartsCanBeDrawn(findings);
    EXPECT_EQ(findings.choices.size(), 7U);
    EXPECT_EQ(findings.conclusions.size(), 3U);
}

TEST(SweepExperiment, NoticesASweepThatDropsOrInventsEvery50thContact) {
    for (const bool drops : {true, false}) {
        const std::vector methods{named("discrete (Sweep::none)"), named("Sweep::box"),
                                  careless(drops, named("Sweep::line"))};
        EXPECT_EQ(
            unexpectedClaims(methods, {drops ? "miss none" : "list no other", "the same pairs"}),
            std::vector<std::string>{});
    }
}

TEST(SweepExperiment, NoticesASweepThatLooksAtTheEndAloneAndADiscreteOneBesideTheTheory) {
    SweepMethod atTheEnd = named("discrete (Sweep::none)");
    atTheEnd.missesNothing = true;
    EXPECT_EQ(unexpectedClaims(std::vector{atTheEnd}, {"miss none"}), std::vector<std::string>{});
    SweepMethod besideTheory = named("Sweep::automatic");
    besideTheory.isDiscrete = true;
    EXPECT_EQ(unexpectedClaims(std::vector{besideTheory}, {"lies on the line"}),
              std::vector<std::string>{});
}

TEST(SweepExperiment, NoticesTimesThatAreNotQuiteTrueAndThoseThatAreNotTold) {
    for (const bool tells : {true, false}) {
        SweepMethod method = named("Sweep::automatic");
        method.contactTime = [tells](const MovingBox<float>& a, const MovingBox<float>& b) {
            const std::optional<double> time = firstContact(a, b);
            return time && tells ? std::optional(static_cast<double>(static_cast<float>(*time)))
                                 : std::nullopt;
        };
        EXPECT_EQ(unexpectedClaims(std::vector{named("discrete (Sweep::none)"), method}, {"Times"}),
                  std::vector<std::string>{});
    }
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
    EXPECT_EQ(truth.moments, (std::vector<Fraction>{{3, 8}, {1, 1}}));
    EXPECT_EQ(truth.moments[0].errorOf(0.5), 0.125);
    frame.objects[1].box.min().x() += 0x1p-12F;
    EXPECT_THROW(static_cast<void>(exactContact(frame, 0, 1)), std::logic_error);
}

}  // namespace
}  // namespace hashphase::demos
