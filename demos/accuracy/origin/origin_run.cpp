// SPDX-License-Identifier: Zlib
#include <demos/accuracy/origin/origin_run.hpp>

#include <demos/accuracy/timing.hpp>

#include <algorithm>
#include <functional>
#include <memory>

namespace hashphase::demos {
namespace {

using Worlds = std::vector<std::unique_ptr<OriginWorld>>;

std::vector<WorldBox> worldBoxes(const OriginScene& scene, const BodyPlacement& place) {
    std::vector<WorldBox> boxes;
    for (const IntegerBox& box : scene.boxes()) {
        boxes.push_back(place(box));
    }
    return boxes;
}

/// A mark for each thing that may be reported.
struct Marks {
    std::vector<char> isTrue;
    std::vector<char> isReported;

    explicit Marks(std::size_t count) : isTrue(count), isReported(count) {}

    [[nodiscard]] std::uint64_t missed() const {
        std::uint64_t count = 0;
        for (std::size_t i = 0; i < isTrue.size(); ++i) {
            count += static_cast<std::uint64_t>(isTrue[i] != 0 && isReported[i] == 0);
        }
        return count;
    }
    [[nodiscard]] std::uint64_t countTrue() const {
        return static_cast<std::uint64_t>(std::count(isTrue.begin(), isTrue.end(), 1));
    }
    /// Marks as reported; returns 1 when that is false, or has been reported before.
    std::uint64_t report(std::size_t i) {
        const bool isFalse = isTrue[i] == 0 || isReported[i] != 0;
        isReported[i] = 1;
        return isFalse ? 1 : 0;
    }
    void forgetReports() { std::fill(isReported.begin(), isReported.end(), 0); }
};

void judgePairs(const OriginScene& scene, const Worlds& worlds,
                std::vector<OriginOutcome>& outcomes) {
    const std::size_t count = scene.boxes().size();
    Marks marks(count * count);
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = i + 1; j < count; ++j) {
            marks.isTrue[i * count + j] =
                overlapExactly(scene.boxes()[i], scene.boxes()[j]) ? 1 : 0;
        }
    }
    for (std::size_t k = 0; k < worlds.size(); ++k) {
        std::vector<PairKey> pairs;
        worlds[k]->listPairs(pairs);
        marks.forgetReports();
        for (const PairKey pair : pairs) {
            outcomes[k].extraPairs += marks.report(firstOf(pair) * count + secondOf(pair));
        }
        outcomes[k].pairs += marks.countTrue();
        outcomes[k].missedPairs += marks.missed();
    }
}

void judgeRays(const OriginScene& scene, const BodyPlacement& place, const Worlds& worlds,
               std::vector<OriginOutcome>& outcomes) {
    for (const IntegerRay& ray : scene.rays()) {
        Marks marks(scene.boxes().size());
        for (std::size_t i = 0; i < scene.boxes().size(); ++i) {
            marks.isTrue[i] = meetExactly(ray, scene.boxes()[i]) ? 1 : 0;
        }
        for (std::size_t k = 0; k < worlds.size(); ++k) {
            std::vector<std::uint32_t> hits;
            worlds[k]->listHits(place(ray), hits);
            marks.forgetReports();
            for (const std::uint32_t hit : hits) {
                outcomes[k].falseHits += marks.report(hit);
            }
            outcomes[k].hits += marks.countTrue();
            outcomes[k].missedHits += marks.missed();
        }
    }
}

}  // namespace

OriginOutcomes runAt(const BodyPlacement& place, OriginScene scene,
                     std::span<const OriginMethod> methods) {
    constexpr int kFramesALook = 10;
    constexpr int kWarmUp = 2;
    const BodyPlacement atOrigin{0, place.unit};
    std::vector<WorldBox> boxes = worldBoxes(scene, place);
    std::vector<WorldBox> boxesAtOrigin = worldBoxes(scene, atOrigin);
    Worlds worlds;
    std::vector<std::function<void()>> timed;
    for (const OriginMethod& method : methods) {
        worlds.push_back(method.make());
        timed.emplace_back([&boxes, world = worlds.back().get()] { world->set(boxes); });
    }
    const std::unique_ptr<OriginWorld> reference = methods.front().make();
    timed.emplace_back([&] { reference->set(boxesAtOrigin); });

    OriginOutcomes outcomes;
    outcomes.methods.resize(methods.size());
    const std::vector<Spread> times = timeInTurn(
        kFewestFrames, kWarmUp,
        [&](int frame) {
            if (frame % kFramesALook == 1) {
                judgePairs(scene, worlds, outcomes.methods);
                judgeRays(scene, place, worlds, outcomes.methods);
            }
            scene.advance();
            boxes = worldBoxes(scene, place);
            boxesAtOrigin = worldBoxes(scene, atOrigin);
        },
        timed);
    for (std::size_t i = 0; i < methods.size(); ++i) {
        outcomes.methods[i].frameMs = times[i];
    }
    outcomes.atOriginMs = times.back();
    return outcomes;
}

}  // namespace hashphase::demos
