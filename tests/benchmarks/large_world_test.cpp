// SPDX-License-Identifier: Zlib

// The world of a million static boxes, at sizes at which all of it can be looked at.

#include <tests/benchmarks/pair_workload.hpp>

#include <gtest/gtest.h>

#include <algorithm>

namespace hashphase::benchmarks {
namespace {

std::unique_ptr<PairWorkload> makeWorkload(std::string_view name, std::size_t objects) {
    const std::vector<Benchmark> all = catalog(1);
    const auto found = std::find_if(all.begin(), all.end(), [name](const Benchmark& benchmark) {
        return benchmark.name == name;
    });
    auto& made = dynamic_cast<PairWorkload&>(*found->make(objects, 3).release());
    return std::unique_ptr<PairWorkload>(&made);
}

std::vector<Aabb<float>> nextBoxes(PairWorkload& workload) {
    workload.beginFrame();
    return workload.scene().boxes();
}

// By object, those that are not in the same place in both frames.
std::vector<std::uint32_t> movedBetween(const std::vector<Aabb<float>>& before,
                                        const std::vector<Aabb<float>>& after) {
    std::vector<std::uint32_t> moved;
    for (std::uint32_t i = 0; i < before.size(); ++i) {
        if (before[i].min() != after[i].min() || before[i].max() != after[i].max()) {
            moved.push_back(i);
        }
    }
    return moved;
}

using Objects = std::vector<std::uint32_t>;

class SettingContestant final : public Contestant {
public:
    explicit SettingContestant(Objects& set) : set_(set) {}

    void fill(const FrameBoxes& /*frame*/) override {}
    void setAll(const FrameBoxes& /*frame*/) override { FAIL() << "sets all"; }
    void set(std::span<const std::uint32_t> objects, const FrameBoxes& /*frame*/) override {
        set_.insert(set_.end(), objects.begin(), objects.end());
    }
    void findPairs() override {}
    void listPairs(std::vector<demos::PairKey>& /*pairs*/) override {}

private:
    Objects& set_;
};

TEST(LargeWorld, HasUpToAHundredMoversWhateverItsSizeAndAtLeastOne) {
    for (const auto& [objects, movers] :
         {std::pair(1, 1), std::pair(9, 1), std::pair(300, 30), std::pair(20'000, 100)}) {
        const auto workload = makeWorkload("large-world", static_cast<std::size_t>(objects));
        EXPECT_EQ(workload->objects(), static_cast<std::size_t>(objects));
        EXPECT_EQ(workload->operations(), static_cast<std::size_t>(movers));
        const FrameBoxes frame = workload->scene().frame();
        for (std::uint32_t i = 0; i < frame.boxes.size(); ++i) {
            const std::span<const std::uint32_t> set = workload->movers();
            EXPECT_EQ(isStatic(frame.filterOf(i)), !std::binary_search(set.begin(), set.end(), i));
        }
    }
}

TEST(LargeWorld, SetsExactlyWhatMovesInEveryFrame) {
    Objects set;
    const ContestantKind kind{.name = "setting", .make = [&set](const demos::BroadphaseNeeds&) {
                                  return std::make_unique<SettingContestant>(set);
                              }};
    const auto workload = makeWorkload("large-world", 5000);
    const std::unique_ptr<Runner> runner = workload->make(kind);
    std::vector<Aabb<float>> before = nextBoxes(*workload);
    for (int frame = 0; frame < 5; ++frame) {
        const std::vector<Aabb<float>> after = nextBoxes(*workload);
        set.clear();
        runner->prepare();
        runner->run();
        EXPECT_EQ(set, movedBetween(before, after));
        before = after;
    }
}

TEST(LargeWorld, PairsItsMoversAlone) {
    for (const char* name : {"large-world", "creation-static"}) {
        const auto workload = makeWorkload(name, 5000);
        workload->beginFrame();
        std::vector<Answer> pairs;
        workload->listExactAnswers(pairs);
        const FrameBoxes frame = workload->scene().frame();
        EXPECT_GT(pairs.size(), 100U) << name;
        for (const Answer pair : pairs) {
            EXPECT_FALSE(isStatic(frame.filterOf(demos::firstOf(pair))) &&
                         isStatic(frame.filterOf(demos::secondOf(pair))))
                << name;
        }
    }
}

}  // namespace
}  // namespace hashphase::benchmarks
