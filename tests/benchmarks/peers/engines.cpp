// SPDX-License-Identifier: Zlib

// Broadphases of whole engines, without the rest of them.

#include <tests/benchmarks/peers/engine_boxes.hpp>
#include <tests/benchmarks/peers/peers.hpp>

#include <algorithm>

namespace hashphase::benchmarks {

EngineBoxes::~EngineBoxes() = default;

namespace {

using demos::PairKey;
using MakeBoxes = EngineBoxes* (*)(const EngineScene&);

const float* floatsOf(std::span<const Aabb<float>> boxes) {
    static_assert(sizeof(Aabb<float>) == 6 * sizeof(float));
    return boxes.empty() ? nullptr : boxes.front().min().data();
}

class EngineContestant final : public Contestant {
public:
    EngineContestant(MakeBoxes makeBoxes, const Aabb<float>& bounds)
        : makeBoxes_(makeBoxes), bounds_(bounds) {}

    void fill(const FrameBoxes& frame) override {
        frame_ = frame;
        std::vector<unsigned char> areStatic(frame.boxes.size());
        for (std::size_t i = 0; i < areStatic.size(); ++i) {
            areStatic[i] = isStatic(frame.filterOf(i)) ? 1 : 0;
        }
        EngineScene scene{floatsOf(frame.boxes), areStatic.data(), areStatic.size(), {}};
        std::copy_n(floatsOf({&bounds_, 1}), 6, scene.bounds);
        boxes_.reset(makeBoxes_(scene));
    }

    void setAll(const FrameBoxes& frame) override { boxes_->set(floatsOf(frame.boxes)); }
    void findPairs() override { boxes_->findPairs(); }

    void listPairs(std::vector<PairKey>& pairs) override {
        pairs.clear();
        for (const PairKey key : std::span(boxes_->pairs(), boxes_->pairCount())) {
            const std::uint32_t first = demos::firstOf(key);
            const std::uint32_t second = demos::secondOf(key);
            if (frame_.mayPair(first, second)) {
                pairs.push_back(demos::pairKey(first, second));
            }
        }
    }

private:
    MakeBoxes makeBoxes_;
    Aabb<float> bounds_;
    FrameBoxes frame_;
    std::unique_ptr<EngineBoxes> boxes_;
};

ContestantKind engineKind(const char* name, const char* title, const char* description,
                          const std::string& package, MakeBoxes makeBoxes) {
    return {.name = name,
            .title = title,
            .description = description,
            .package = package,
            .make = [makeBoxes](const demos::BroadphaseNeeds& needs) {
                return std::make_unique<EngineContestant>(makeBoxes, needs.bounds);
            }};
}

std::string packageText(std::string package, EngineVersion version) {
    const char* separator = " ";
    for (const int number : version.numbers) {
        package += separator + std::to_string(number);
        separator = ".";
    }
    return package + ", with its own flags";
}

}  // namespace

#ifdef HASHPHASE_BENCHMARKS_JOLT_PACKAGE
std::vector<ContestantKind> joltKinds() {
    ContestantKind jolt =
        engineKind("jolt", "JPH::BroadPhaseQuadTree",
                   "Jolt's quad tree; boxes that did not move since the last frame sleep",
                   packageText(HASHPHASE_BENCHMARKS_JOLT_PACKAGE, joltVersion()), makeJoltBoxes);
    constexpr std::size_t kMostBodies = 0x800000;  // that Jolt numbers
    jolt.upTo = kMostBodies;
    return {std::move(jolt)};
}
#endif

#ifdef HASHPHASE_BENCHMARKS_PHYSX_PACKAGE
std::vector<ContestantKind> physxKinds() {
    const std::string package = packageText(HASHPHASE_BENCHMARKS_PHYSX_PACKAGE, physxVersion());
    return {engineKind("physx-abp", "physx::PxBroadPhase, eABP", "PhysX's automatic box pruning",
                       package, makePhysxAutomaticBoxes),
            engineKind("physx-mbp", "physx::PxBroadPhase, eMBP",
                       "PhysX's box pruning in regions, a grid over the scene", package,
                       makePhysxRegionBoxes)};
}
#endif

}  // namespace hashphase::benchmarks
