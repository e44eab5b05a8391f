// SPDX-License-Identifier: Zlib
//
// The experiments on pairs, P2 and P10, at a tiny size: that their checks hold, and that they
// notice a method that gets a pair wrong.

#include <demos/accuracy/baselines/paper_grid.hpp>
#include <demos/accuracy/pairs/cell_size.hpp>
#include <demos/accuracy/pairs/update_policies.hpp>
#include <tests/demos/accuracy/findings_checks.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>

namespace hashphase::demos {
namespace {

enum class Flaw { kMissesOne, kInventsOne };

/// Another one's pairs, but for one in every frame.
class BrokenSource : public PairSource {
public:
    BrokenSource(Flaw flaw, std::unique_ptr<PairSource> source)
        : flaw_(flaw), source_(std::move(source)) {}

    void step(std::span<const BulletBox> boxes) override { source_->step(boxes); }
    void listPairs(std::vector<PairKey>& pairs) const override {
        source_->listPairs(pairs);
        if (flaw_ == Flaw::kMissesOne) {
            pairs.pop_back();
        } else {
            pairs.push_back(pairKey(0xfffffffe, 0xffffffff));
        }
    }

private:
    Flaw flaw_;
    std::unique_ptr<PairSource> source_;
};

void breakMethod(Flaw flaw, PairMethod& method) {
    method.make = [flaw, make = std::move(method.make)](const BroadphaseNeeds& needs,
                                                        std::span<const BulletBox> boxes) {
        return std::make_unique<BrokenSource>(flaw, make(needs, boxes));
    };
}

using IsOf = bool (*)(const PairMethod& method);
using Measure = Findings (*)(const std::function<void(std::vector<PairMethod>&)>& change);

Findings measureTinyCellSizes(const std::function<void(std::vector<PairMethod>&)>& change) {
    const std::vector<double> factors{0.5, 2, 16};
    const std::vector<CellCase> cases{{"uniform", {}, 150, factors},
                                      {"sizes", {SizeLaw::logUniform, 100}, 150, factors}};
    const CellMethods methods = [&](const CellCase& each, std::span<const BulletBox> boxes,
                                    double meanEdge) {
        std::vector<PairMethod> all = cellMethods(each, boxes, meanEdge);
        change(all);
        return all;
    };
    return measureCellSizes(cases, methods, 1, ignoreProgress);
}

Findings measureFewUpdates(const std::function<void(std::vector<PairMethod>&)>& change) {
    std::vector<PairMethod> policies = updatePolicies();
    change(policies);
    const UpdatePlan plan{200, {{0}, {0.05}, {1}, {1, 0.2}}, {8, 2, 8}};
    return measurePolicies(plan, policies, 1, ignoreProgress);
}

struct PairFault {
    const char* what;
    Measure measure;
    Flaw flaw;
    IsOf isBroken;  // the first such method; all of the paper's
    std::size_t brokenChecks;
};

bool isLevels(const PairMethod& method) {
    return method.name == "levels";
}
bool isByCorners(const PairMethod& method) {
    return method.origin == kOfPaper && !method.isExact;
}
bool isExact(const PairMethod& method) {
    return method.isExact;
}
bool isOnlyComplete(const PairMethod& method) {
    return method.isComplete && !method.isExact;
}

TEST(PairExperiments, HoldForEveryMethod) {
    for (const Measure measure : {measureTinyCellSizes, measureFewUpdates}) {
        const Findings findings = measure([](std::vector<PairMethod>&) {});
        EXPECT_EQ(brokenClaims(findings), std::vector<std::string>{});
        expectChartsCanBeDrawn(findings);
        EXPECT_FALSE(findings.choices.empty());
        EXPECT_FALSE(findings.conclusions.empty());
    }
}

TEST(PairExperiments, NoticeAMethodThatGetsAPairWrong) {
    // Updates that miss a pair do so where nothing moves as well.
    const PairFault faults[] = {
        {"a cell size misses", measureTinyCellSizes, Flaw::kMissesOne, isLevels, 1},
        {"a cell size invents", measureTinyCellSizes, Flaw::kInventsOne, isLevels, 1},
        {"corners of large cells miss", measureTinyCellSizes, Flaw::kMissesOne, isByCorners, 1},
        {"an exact policy invents", measureFewUpdates, Flaw::kInventsOne, isExact, 1},
        {"an exact policy misses", measureFewUpdates, Flaw::kMissesOne, isExact, 2},
        {"a complete policy misses", measureFewUpdates, Flaw::kMissesOne, isOnlyComplete, 2},
    };
    for (const auto& [what, measure, flaw, isBroken, brokenChecks] : faults) {
        SCOPED_TRACE(what);
        const Findings findings = measure([&](std::vector<PairMethod>& methods) {
            for (PairMethod& method : methods) {
                if (isBroken(method)) {
                    breakMethod(flaw, method);
                    if (method.origin != kOfPaper) {
                        break;
                    }
                }
            }
        });
        EXPECT_EQ(brokenClaims(findings).size(), brokenChecks);
    }
}

TEST(PaperGrid, MissesByCornersOnlyWhatLiesInTheMiddleOfALargeBox) {
    // The large one spans cells 0 to 2, the small one lies in cell 1.
    const std::vector<BulletBox> boxes{{{0, 0, 0}, {2.5F, 0.5F, 0.5F}},
                                       {{1.2F, 0.2F, 0.2F}, {1.4F, 0.4F, 0.4F}},
                                       {{2.1F, 0.2F, 0.2F}, {2.3F, 0.4F, 0.4F}}};
    const auto pairsBy = [&](FiledCells filed) {
        const auto source = paperGridMethod("paper", 1, filed).make({}, boxes);
        source->step(boxes);
        std::vector<PairKey> pairs;
        source->listPairs(pairs);
        return pairs;
    };
    EXPECT_EQ(pairsBy(FiledCells::kAll), (std::vector<PairKey>{pairKey(0, 1), pairKey(0, 2)}));
    EXPECT_EQ(pairsBy(FiledCells::kCorners), (std::vector<PairKey>{pairKey(0, 2)}));
    EXPECT_EQ(filedCellCount(boxes, 1), 5);
}

}  // namespace
}  // namespace hashphase::demos
