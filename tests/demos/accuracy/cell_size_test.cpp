// SPDX-License-Identifier: Zlib
#include <demos/accuracy/baselines/paper_grid.hpp>
#include <demos/accuracy/pairs/cell_size.hpp>
#include <tests/demos/accuracy/broken_pairs.hpp>
#include <tests/demos/accuracy/findings_checks.hpp>

#include <gtest/gtest.h>

namespace hashphase::demos {
namespace {

std::vector<CellCase> tinyCases() {
    CellCase near;
    near.population = "uniform";
    near.objects = 150;
    near.factors = {0.5, 2, 16};
    CellCase sizes = near;
    sizes.population = "sizes";
    sizes.plan.sizes = SizeLaw::logUniform;
    sizes.plan.sizeRatio = 100;
    return {near, sizes};
}

Findings measureWith(const CellMethods& methods) {
    return measureCellSizes(tinyCases(), methods, {}, ignoreProgress);
}

CellMethods withBroken(Flaw flaw) {
    return [flaw](const CellCase& each, double meanEdge) {
        std::vector<CellMethod> methods = cellMethods(each, meanEdge);
        methods[1].pairs = broken(flaw, methods[1].pairs);
        return methods;
    };
}

std::vector<std::string> brokenWith(Flaw flaw) {
    return brokenClaims(measureWith(withBroken(flaw)));
}

TEST(CellSizeExperiment, HoldsForEveryCellSize) {
    const Findings findings = measureWith(cellMethods);
    EXPECT_EQ(brokenClaims(findings), std::vector<std::string>{});
    expectChartsCanBeDrawn(findings);
    EXPECT_FALSE(findings.choices.empty());
    EXPECT_FALSE(findings.conclusions.empty());
}

TEST(CellSizeExperiment, NoticesACellSizeThatMissesAPair) {
    EXPECT_EQ(brokenWith(Flaw::kMissesOne).size(), 1U);
}

TEST(CellSizeExperiment, NoticesACellSizeThatInventsAPair) {
    EXPECT_EQ(brokenWith(Flaw::kInventsOne).size(), 1U);
}

TEST(CellSizeExperiment, NoticesCornerCellsThatMissWhatIsNoLargerThanACell) {
    const CellMethods methods = [](const CellCase& each, double meanEdge) {
        std::vector<CellMethod> all = cellMethods(each, meanEdge);
        for (CellMethod& method : all) {
            if (method.pairs.origin == kOfPaper && !method.pairs.isExact) {
                method.pairs = broken(Flaw::kMissesOne, method.pairs);
            }
        }
        return all;
    };
    EXPECT_EQ(brokenClaims(measureWith(methods)).size(), 1U);
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
